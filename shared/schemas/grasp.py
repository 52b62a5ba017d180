"""Grasp proposal and matching: candidates in, the grasps in the region out."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from shared.schemas.fields import (
    Direction,
    GraspRows,
    HeldShares,
    Labels,
    Mask,
    Points,
    Quaternion,
    SuperquadricRows,
    Vector3,
)
from shared.schemas.gripper import GripperList
from shared.schemas.primitive import Primitive
from shared.schemas.rejection import Examples, LeftOut, LeftOutFor, RejectedRows, RejectionCode
from shared.schemas.route import Nothing, Route
from shared.schemas.scene import SupportPlane
from shared.wire import ArrayField, Message


class Pose(Message):
    """Grasp frame: the tool centre point midway between the finger tips.

    +z is the approach direction, +y the closing direction, x completes it.
    """

    position: Vector3
    quaternion: Quaternion


class ProposeRequest(Message):
    """An object in its surroundings."""

    points: Points
    obstacle_points: Points | None = None
    plane: SupportPlane | None = None
    up: Direction | None = None
    viewpoint: Vector3 = (0.0, 0.0, 0.0)
    focus: Mask | None = None
    """Sample only at these points; the whole object still counts for collisions."""
    superquadrics: SuperquadricRows | None = None
    """What was recovered from the object: says where its mass is and where it goes on unseen."""
    gripper: str = "panda"
    samples: Annotated[int, Field(ge=1, le=5000)] = 300
    seed: Annotated[int, Field(ge=0, lt=2**32)] = 0
    rejected: Examples = 0
    """So many of the hand poses that are left out are in the answer, too."""


class ProposeResponse(Message):
    """Collision-free antipodal candidates, best first."""

    grasps: GraspRows
    on_focus: HeldShares
    """How much of what each grasp holds is in the request's focus."""
    keeps_clear: Mask
    """For each grasp: on its way in the hand stays 10 mm away from all of the object that is
    farther from the focus than a finger is wide, so that it leaves the parts free that the task
    needs."""
    doubtful: Mask
    """For each grasp: whether it holds is in doubt, because its score is low or the weight turns
    the object between the pads, and a simulation would tell, because the superquadrics are not
    where the open fingers are seen to have room."""
    considered: int
    rejected: dict[str, int]
    """How many hand poses were left out, by reason."""
    rejected_poses: LeftOut = None
    """Some of them, as the request asked for, spread over reasons and places."""
    rejected_reasons: LeftOutFor = ()
    """Why each of them was left out."""


class RegionRequest(Message):
    """Asks which points belong to which primitive, and which to the chosen ones."""

    points: Points
    primitives: tuple[Primitive, ...]
    primitive_ids: tuple[int, ...]
    """The primitives of the grasp region."""
    point_primitive: Labels | None = None
    """Which part each point was cut to, where the recovery knows; None: by distance."""


class RegionResponse(Message):
    """One entry per point of the request."""

    point_primitive: Labels
    """As the request gave it, or else the nearest primitive by radial distance (Eq. 5.1);
    -1 for none."""
    point_region: Mask


class SelectRequest(Message):
    """Asks which of these grasps hold the region."""

    points: Points
    point_region: Mask
    grasps: GraspRows
    on_region: HeldShares | None = None
    """How much of what each grasp holds is in the region, where the proposer says so; without
    it, only the closest point decides."""
    keeps_clear: Mask | None = None
    """Which grasps stay away from the rest of the object: they go first among equals."""
    max_grasps: Annotated[int, Field(ge=0, le=100)] = 10
    rejected: Examples = 0
    """So many hand poses that are not among the grasps are in the answer, too: of those that
    are left out here, and of `rejected_poses`."""
    rejected_poses: RejectedRows | None = None
    """Hand poses that the proposer left out."""
    rejected_reasons: tuple[RejectionCode, ...] = ()
    """Why it did, one for each."""
    seed: Annotated[int, Field(ge=0, lt=2**32)] = 0
    """Chooses among the hand poses that are left out; grasps do not depend on it."""


class SelectResponse(Message):
    """The grasps that hold the region, best first."""

    grasps: GraspRows
    indices: Annotated[NDArray[np.int32], ArrayField("int32", ("G",))]
    """Row of each in the request."""
    outside_region: int
    """How many candidates held another part."""
    rejected_poses: LeftOut = None
    """Hand poses that are not among the grasps, as the request asked for."""
    rejected_reasons: LeftOutFor = ()
    """Why each of them is not."""


LIST_GRIPPERS = Route(
    "grasp_proposal", "/grippers", Nothing, GripperList, "The grippers that are known", "GET"
)
PROPOSE = Route(
    "grasp_proposal",
    "/propose",
    ProposeRequest,
    ProposeResponse,
    "Propose 6-DOF antipodal grasps that collide with nothing",
)
FIND_REGION = Route(
    "matching",
    "/region",
    RegionRequest,
    RegionResponse,
    "Assign points to primitives by radial distance",
)
SELECT = Route(
    "matching",
    "/select",
    SelectRequest,
    SelectResponse,
    "Keep the grasps that hold the region",
)
