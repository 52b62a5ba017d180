"""Perception: one depth view in, one object on its support plane out."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, FiniteFloat, model_validator

from shared.schemas.fields import FARTHEST_M, Direction, Indices, Metres, Points, Vector3
from shared.schemas.route import Route
from shared.wire import ArrayField, Message

InputKind = Literal["scene", "object"]


class View(Message):
    """What a sensor saw: points, or a depth image with its intrinsics.

    `points` may hold non-finite rows (no return). Depth of zero or a non-finite
    value means no return; pixels count row-major, so a view has H*W points.
    """

    points: Points | None = None
    depth: Annotated[NDArray[Any], ArrayField("", ("H", "W"))] | None = None
    intrinsics: Annotated[NDArray[np.float64], ArrayField("float64", (3, 3))] | None = None
    depth_scale: Annotated[FiniteFloat, Field(gt=0)] | None = None
    """Metres per unit of depth; needed for integer depth, 1.0 for floats."""
    viewpoint: Vector3 = (0.0, 0.0, 0.0)
    """Position of the sensor in the view's frame."""

    @model_validator(mode="after")
    def _one_kind_of_input(self) -> Self:
        if (self.points is None) == (self.depth is None):
            found = "neither" if self.points is None else "both"
            raise ValueError(f"give either points or depth with intrinsics, found {found}")
        if self.depth is not None:
            if self.intrinsics is None:
                raise ValueError("depth needs intrinsics, a 3x3 pinhole matrix in pixels")
            k = self.intrinsics
            if not (np.isfinite(k).all() and k[0, 0] > 0 and k[1, 1] > 0):
                raise ValueError("intrinsics must be finite with positive focal lengths")
            if self.depth.dtype.kind in "iu" and self.depth_scale is None:
                raise ValueError("integer depth needs depth_scale, in metres per unit")
        return self


class SupportPlane(Message):
    """The surface that the object stands on: `normal . p + offset = 0`."""

    normal: Direction
    """Unit vector towards the side where the objects are."""
    offset: Metres
    inliers: int
    residual_mm: Annotated[FiniteFloat, Field(ge=0, le=FARTHEST_M)]
    """Robust standard deviation of the surface points about the plane."""


class PerceiveRequest(View):
    """A view, and which object of it is meant."""

    input: InputKind = "scene"
    target: Vector3 | None = None
    """Pick the object nearest to this point; without it, the most central one."""
    seed: Annotated[int, Field(ge=0, lt=2**32)] = 0


class PerceiveResponse(Message):
    """The target object and what surrounds it, in the view's frame."""

    object_points: Points
    object_indices: Indices
    """Row of each object point in the input."""
    obstacle_points: Points
    """Other things near the object that a hand could hit, thinned out; not the support plane."""
    plane: SupportPlane | None
    """None where no support surface was seen, as with `input = object`."""
    up: Direction
    """Unit vector against gravity: the plane's normal; without a plane, best guess."""
    input_points: int
    dropped: dict[str, int]
    """How many input points were left out, by reason: invalid, support, other."""
    clusters: int
    """How many objects there were to choose from."""


PERCEIVE = Route(
    "perception",
    "/perceive",
    PerceiveRequest,
    PerceiveResponse,
    "Find the support plane and the target object in one view",
)
