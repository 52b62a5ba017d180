"""Execution: a grasp in, whether it lifted the object out."""

from __future__ import annotations

import operator
from typing import Annotated, Any, Literal, Self, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, FiniteFloat, model_validator

from shared.schemas.fields import Direction, Mask, Points, SuperquadricVector, Vector3
from shared.schemas.grasp import Pose
from shared.schemas.route import Route
from shared.schemas.scene import SupportPlane
from shared.wire import ArrayField, Message

Outcome = Literal[
    "lifted",
    "held",
    "unreachable",
    "collision_with_table",
    "pushed_away",
    "missed",
    "slipped_in_lift",
    "slipped_in_shake",
]


Believed = Literal["primitives", "reflected"]
"""What the other side of an object, which nobody has seen, is taken for."""
BELIEVED: tuple[Believed, ...] = get_args(Believed)

Series = Annotated[NDArray[np.float64], ArrayField("float64", ("F",))]
PoseRows = Annotated[NDArray[np.float64], ArrayField("float64", ("F", 7))]
"""x y z qx qy qz qw"""
JointRows = Annotated[NDArray[np.float64], ArrayField("float64", ("F", 7))]
PoseRow = Annotated[NDArray[np.float64], ArrayField("float64", (7,))]
_WHERE_ASKED = Field(exclude_if=lambda array: array is None)


class ExecuteRequest(Message):
    """A grasp on an object: a mesh, or the primitives that stand for it.

    Everything is in one frame; `plane` says where the table is.
    """

    pose: Pose
    width: Annotated[FiniteFloat, Field(ge=0)]
    primitives: Annotated[tuple[SuperquadricVector, ...], Field(max_length=64)] = ()
    vertices: Points | None = None
    """Mesh vertices in metres, in the same frame as the grasp, or in the mesh's own frame
    where `object_pose` is given."""
    faces: Annotated[NDArray[np.int32], ArrayField("int32", ("F", 3))] | None = None
    object_pose: Pose | None = None
    """Where the mesh's own frame is in the frame of the grasp. Many requests about one mesh
    are answered sooner with it: a mesh is prepared once, as long as its arrays stay the same."""
    points: Points | None = None
    """Seen of the object, in the frame of the grasp: with them, `believed` may complete it."""
    viewpoint: Vector3 = (0.0, 0.0, 0.0)
    """Of the sensor that saw them."""
    believed: Believed = "primitives"
    """What the object looks like where no mesh is given: as the primitives do, or as the points do
    and, on the other side of each primitive, the same points, reflected away from the sensor."""
    mass: Annotated[FiniteFloat, Field(gt=0, le=100)] | None = None
    """Of the object, kg; None: a guess by its volume, 400 kg/m3 and between 0.05 and 0.6 kg."""
    plane: SupportPlane | None = None
    up: Direction | None = None
    gripper: str = "panda"
    """A name from GET /grippers."""
    actor: Literal["arm", "hand"] | None = None
    """`arm`: the whole Panda arm with inverse kinematics, for the gripper `panda` alone;
    `hand`: the gripper flies by itself. None: the arm where there is one."""
    strict: bool = False
    """Shake and tilt the object after the lift, too."""
    heading: Direction | None = None
    """Where the robot faces: its `strict` shaking goes to its left and right, its tilting forward.
    None, or straight up or down: as the grasp comes, so that the world follows the grasp."""
    brisk: bool = False
    """In half the time: the solver iterates a third as often, and a free hand closes, lifts, holds
    and tilts twice as fast. What is held by a narrow margin may come out otherwise."""
    seed: Annotated[int, Field(ge=0, lt=2**32)] = 0
    animate: bool = False
    """Film what happens; changes nothing about it, but takes a few seconds longer."""
    motion: bool = False
    """Give what happens as arrays, 24 times per simulated second; changes nothing about it."""
    highlight: Mask | None = None
    """Faces (F,) of the mesh that the film shows in another colour, as the part to hold."""

    @model_validator(mode="after")
    def _one_object(self) -> Self:
        if (self.vertices is None) != (self.faces is None):
            raise ValueError("a mesh needs both vertices and faces")
        if self.vertices is None and not self.primitives:
            raise ValueError("give a mesh (vertices, faces) or primitives")
        if self.vertices is not None and self.faces is not None:
            self._check_mesh(self.vertices, self.faces)
        if self.highlight is not None and len(self.highlight) != (
            0 if self.faces is None else len(self.faces)
        ):
            raise ValueError("highlight needs one entry for every face of the mesh")
        if self.plane is None and self.up is None:
            raise ValueError("give plane or up, so that gravity has a direction")
        if self.believed != "primitives" and (self.points is None or not self.primitives):
            raise ValueError(f"{self.believed} completes primitives by points: give both")
        if self.points is not None and not (len(self.points) and np.isfinite(self.points).all()):
            raise ValueError("points must be some, and finite")
        if self.object_pose is not None and self.vertices is None:
            raise ValueError("object_pose places a mesh; primitives are given where they are")
        return self

    @staticmethod
    def _check_mesh(vertices: NDArray[Any], faces: NDArray[Any]) -> None:
        if len(faces) == 0 or not np.isfinite(vertices).all():
            raise ValueError("the mesh needs at least one face and finite vertices")
        if faces.min() < 0 or faces.max() >= len(vertices):
            raise ValueError(f"faces must index the {len(vertices)} vertices from 0")


class Phase(Message):
    """One step of the motion."""

    name: str
    simulated_s: float
    """Simulated time at its end."""


class ExecuteResponse(Message):
    """What happened when the arm, or the hand alone, tried."""

    success: bool
    """All that was asked for went well: the lift and, where `strict`, shake and tilt."""
    lifted: bool
    """The object was lifted and held for a second, whatever came after."""
    outcome: Outcome
    """`lifted`: as asked, without shake and tilt; `held`: with them."""
    message: str
    lift_height: float
    """How far the object rose, in metres."""
    phases: tuple[Phase, ...]
    animation: Annotated[NDArray[np.uint8], ArrayField("uint8", ("B",))] | None = None
    """The bytes of an animated GIF, at most 4 MiB, where one was asked for; None when
    nothing moved because no motion was found or the grasp was refused."""
    motion_times: Annotated[Series | None, _WHERE_ASKED] = None
    """Simulated time in seconds of each of F moments, on the clock of `phases`; this and
    what follows only where `motion` asked for it and something moved."""
    motion_object: Annotated[PoseRows | None, _WHERE_ASKED] = None
    """Where the object's frame is, in the frame of the grasp: that of the mesh where the request
    has `object_pose`, and else one that is the frame of the request while nothing has moved.
    Points of the object as the request gave them, moved by this pose, are where it is then."""
    motion_hand: Annotated[PoseRows | None, _WHERE_ASKED] = None
    """Where the grasp frame of the hand is, the tool centre point between the finger tips."""
    motion_opening: Annotated[Series | None, _WHERE_ASKED] = None
    """Between the pads, in metres; 0 for a suction cup."""
    motion_phases: Annotated[tuple[str, ...], Field(exclude_if=operator.not_)] = ()
    """What was being done, for each moment; names as in `phases`."""
    motion_joints: Annotated[JointRows | None, _WHERE_ASKED] = None
    """Of the arm, in radians from base to hand; None where a hand flew by itself."""
    motion_base: Annotated[PoseRow | None, _WHERE_ASKED] = None
    """Where the arm stands, panda_link0: x y z qx qy qz qw."""


EXECUTE = Route(
    "execution",
    "/execute",
    ExecuteRequest,
    ExecuteResponse,
    "Carry out a grasp in PyBullet, with the Panda arm or a gripper alone, and say what happened",
)
