"""Grippers as data: what a hand is, whatever the robot behind it."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, FiniteFloat, model_validator

from shared.schemas.fields import Name, Vector3
from shared.schemas.urdf import Urdf
from shared.wire import Message

Length = Annotated[FiniteFloat, Field(gt=0, le=1)]
"""Metres."""
Force = Annotated[FiniteFloat, Field(gt=0, le=1000)]
"""Newtons."""


class ParallelGripper(Message):
    """Two fingers that close along y; metres, in the grasp frame."""

    kind: Literal["parallel"] = "parallel"
    name: Name
    description: str
    max_opening: Length
    """Largest distance between the pads."""
    finger_width: Length
    """Along x."""
    finger_thickness: Length
    """Of each finger along y, outside the opening."""
    finger_length: Length
    """From the palm to the tips, along z."""
    tip_beyond_tcp: Annotated[FiniteFloat, Field(ge=0, le=1)]
    """How far the tips reach past the tool centre point along +z."""
    palm_size: Vector3
    """Box of the hand behind the fingers: along x, y, z."""
    force: Force = 20.0
    """With which each finger presses."""
    urdf: Urdf | None = None
    """Its links and joints; None: nobody wrote them down, so poses of links are not known."""

    @model_validator(mode="after")
    def _strokes_reach_the_opening(self) -> Self:
        strokes = self.urdf.strokes if self.urdf else ()
        if strokes and abs(strokes[-1].opening - self.max_opening) > 1e-9:
            raise ValueError(
                f"the strokes end at {strokes[-1].opening} m, max_opening is {self.max_opening} m"
            )
        return self


class SuctionGripper(Message):
    """One round vacuum cup; metres, in the grasp frame.

    The tool centre point is the middle of the lip, +z points into the object. A cup
    has no closing direction: +y is free, and `width` of its grasps is 0.
    """

    kind: Literal["suction"]
    name: Name
    description: str
    cup_diameter: Length
    """Of the lip that seals."""
    cup_length: Length
    """From the palm to the lip, along z."""
    compliance: Length
    """By how much the lip follows a surface that is not flat: the largest difference in
    height along the rim over which it still seals."""
    palm_size: Vector3
    """Box of the body behind the cup: along x, y, z."""
    force: Force
    """With which the cup holds straight out when it seals: underpressure times area."""
    urdf: Urdf | None = None
    """Its links; a cup has no joints."""


Gripper = Annotated[ParallelGripper | SuctionGripper, Field(discriminator="kind")]


class GripperList(Message):
    """All grippers that can be asked for."""

    grippers: tuple[Gripper, ...]
