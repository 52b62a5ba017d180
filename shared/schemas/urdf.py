"""What a gripper is called in its robot description, and where its parts are there."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Self

from pydantic import Field, FiniteFloat, model_validator

from shared.schemas.fields import Vector3
from shared.wire import Message

RosName = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_/]{0,127}$")]
"""Of a link or a joint."""
Angles = tuple[FiniteFloat, FiniteFloat, FiniteFloat]
TCP = "tcp"
"""What the grasp frame itself is called where a link is chosen."""


class Link(Message):
    """A link, and where the grasp frame lies in it while the gripper is fully open.

    Written as URDF writes `<origin xyz rpy>`: the grasp frame is the child.
    """

    name: RosName
    xyz: Vector3
    rpy: Angles = (0.0, 0.0, 0.0)
    """Roll, pitch, yaw about the link's fixed axes, radians."""


class Stroke(Message):
    """Where the fingers are at one opening."""

    opening: Annotated[FiniteFloat, Field(ge=0, le=1)]
    """Distance between the pads, metres."""
    positions: Annotated[tuple[FiniteFloat, ...], Field(max_length=16)]
    """Of the joints, in their order: metres or radians."""
    advance: Annotated[FiniteFloat, Field(ge=0, le=1)] = 0.0
    """How much farther along +z the pads are than fully open: fingers on a linkage move on
    an arc. Metres."""


class Urdf(Message):
    """The names of a gripper's public robot description, and its kinematics there."""

    links: Annotated[tuple[Link, ...], Field(min_length=1, max_length=16)]
    """The first is the one whose pose MoveIt's usual configuration expects of a grasp."""
    joints: Annotated[tuple[RosName, ...], Field(max_length=16)] = ()
    """Those that are commanded; none of a suction cup."""
    strokes: Annotated[tuple[Stroke, ...], Field(max_length=64)] = ()
    """From closed to fully open; between two of them everything is linear."""

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        names = [link.name for link in self.links]
        if len(set(names)) != len(names) or TCP in names:
            raise ValueError(f"links need names that differ, and none is {TCP!r}; found {names}")
        if bool(self.joints) != bool(self.strokes):
            raise ValueError("joints need strokes, and strokes joints")
        if any(len(stroke.positions) != len(self.joints) for stroke in self.strokes):
            raise ValueError(f"every stroke needs {len(self.joints)} positions, one per joint")
        openings = [stroke.opening for stroke in self.strokes]
        if any(low >= high for low, high in pairwise(openings)):
            raise ValueError(f"strokes go from closed to open; found openings {openings}")
        if len(openings) == 1 or (openings and openings[0] != 0):
            raise ValueError("strokes begin at the opening 0 and end at the widest")
        return self
