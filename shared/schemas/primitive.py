"""Primitive recovery: object points in, classified superquadrics out."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from shared.schemas.fields import Direction, Points, SuperquadricVector, Vector3
from shared.schemas.route import Route
from shared.schemas.scene import SupportPlane
from shared.superquadric import Superquadric
from shared.wire import Message

ShapeClass = Literal["cuboid", "cylinder", "sphere"]
Preset = Literal["simulation", "real_world"]


class Primitive(Message):
    """One recovered superquadric."""

    id: Annotated[int, Field(ge=0)]
    parameters: SuperquadricVector
    shape_class: ShapeClass
    shape_probability: Annotated[float, Field(ge=0, le=1)]
    full_extents: Vector3
    """2a in metres, in the order a1, a2, a3: what the rules call dimensions."""
    residual_mm: Annotated[float, Field(ge=0)]
    """Root mean square radial distance of the points it was fitted to, in millimetres."""
    support: Annotated[int, Field(ge=0)]
    """Number of points it was fitted to."""

    @property
    def superquadric(self) -> Superquadric:
        return Superquadric.from_vector(self.parameters)


class RecoverRequest(Message):
    """An object's visible points in metres, and what perception knows around it."""

    points: Points
    viewpoint: Vector3 = (0.0, 0.0, 0.0)
    plane: SupportPlane | None = None
    up: Direction | None = None
    preset: Preset | None = None
    """Parameters of Table A.1; without it, the service's own setting."""
    seed: Annotated[int, Field(ge=0, lt=2**32)] = 0


class RecoverResponse(Message):
    """The primitives, largest support first; ids count from 0."""

    primitives: tuple[Primitive, ...]
    removed_as_overlap: int
    """How many primitives Algorithm 2 took away."""


RECOVER = Route(
    "primitive_recovery",
    "/recover",
    RecoverRequest,
    RecoverResponse,
    "Decompose object points into superquadrics and classify their shapes",
)
