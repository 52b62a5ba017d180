"""The gateway's answer to POST /grasp."""

from __future__ import annotations

import operator
from typing import Annotated

from pydantic import Field

from shared.schemas.execution import Outcome
from shared.schemas.fields import Direction
from shared.schemas.grasp import Pose
from shared.schemas.primitive import Method, Primitive
from shared.schemas.rehearsal import Rehearsal
from shared.schemas.rejection import RejectionCode
from shared.schemas.route import Route
from shared.schemas.scene import SupportPlane
from shared.schemas.task import Explanation, Reason, Region, Version
from shared.wire import Message


class LabelledPrimitive(Primitive):
    """A primitive with its part affordances (Version 2)."""

    labels: tuple[str, ...] = ()


class Grasp(Message):
    """A way to hold the region, in the input's frame."""

    pose: Pose
    pregrasp: Pose
    """Where to start the straight approach along +z."""
    retreat: Pose
    """Where to lift the object to."""
    width: float
    """Opening in metres that the grasp needs."""
    score: Annotated[float, Field(ge=0, le=1)]
    rehearsed: Annotated[tuple[Outcome, ...], Field(exclude_if=operator.not_)] = ()
    """What came of it in simulation, where it was tried: on the primitives, and on the seen
    points, completed."""


class Rejection(Message):
    """Why a hand pose was left out; the codes are listed in docs/rejected.md."""

    code: RejectionCode
    message: str


class RejectedGrasp(Message):
    """A hand pose that was considered and left out, in the input's frame."""

    pose: Pose
    width: float
    """Opening in metres that it would need; where it is `too_wide`, at least so much."""
    reason: Rejection


class Scene(Message):
    """What the answer rests on."""

    plane: SupportPlane | None
    up: Direction
    object_points: int
    clusters: int
    dropped: dict[str, int]
    method: Method
    """How the object was cut into parts."""
    removed_as_overlap: int
    candidates: int
    """Hand poses that were considered."""
    rejected: dict[str, int]
    """How many of them were left out, by reason."""


class GraspAnswer(Message):
    """found = False is an answer; an empty one always says why in `reason`."""

    request_id: str
    task: str
    reasoning: Version
    rule_set: str
    gripper: str
    seed: int
    frame_id: str
    found: bool
    reason: Reason | None
    region: Region | None
    alternatives: tuple[Region, ...]
    primitives: tuple[LabelledPrimitive, ...]
    grasps: tuple[Grasp, ...]
    rejected: Annotated[tuple[RejectedGrasp, ...], Field(exclude_if=operator.not_)] = ()
    """Examples of hand poses that were left out, where some were asked for."""
    rehearsal: Annotated[Rehearsal | None, Field(exclude_if=lambda held: held is None)] = None
    """How grasps were tried before they were answered, where that was needed."""
    explanation: Explanation | None
    scene: Scene
    timings_ms: dict[str, float]


class KeptExplanation(Message):
    """Why an earlier answer was as it was."""

    request_id: str
    task: str
    reasoning: Version
    rule_set: str
    found: bool
    reason: Reason | None
    region: Region | None
    alternatives: tuple[Region, ...]
    explanation: Explanation


class RequestName(Message):
    """Which request is meant."""

    request_id: Annotated[str, Field(min_length=1, max_length=128)]


EXPLANATION = Route(
    "gateway",
    "/grasp/{request_id}/explanation",
    RequestName,
    KeptExplanation,
    "Why an earlier request was answered as it was",
    "GET",
)
