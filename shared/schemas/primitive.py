"""Primitive recovery: object points in, classified superquadrics out."""

from __future__ import annotations

from collections.abc import Sequence
from types import MappingProxyType
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, FiniteFloat

from shared.schemas.fields import Direction, Labels, Points, SuperquadricVector, Vector3
from shared.schemas.route import Route
from shared.schemas.scene import SupportPlane
from shared.superquadric import Superquadric
from shared.wire import ArrayField, Message

ShapeClass = Literal["cuboid", "cylinder", "sphere"]
Preset = Literal["simulation", "real_world"]
Method = Literal["parts", "ems"]
"""`parts` cuts the cloud where the object's parts meet, then fits each; `ems` is the thesis's
hierarchical EMS."""


class Deformation(Message):
    """Taper and bend on top of a superquadric (Solina and Bajcsy 1990), in its own frame."""

    taper: tuple[FiniteFloat, FiniteFloat]
    """(kx, ky): at height z the cross-section is scaled by 1 + k z / a3 along x and y."""
    bend: tuple[FiniteFloat, FiniteFloat]
    """Curvature of the z axis in 1/m, and the direction about z in radians that it bends to."""


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
    deformation: Deformation | None = None
    """Where taper or bend explain the points better; `parameters` are those without them."""
    holes: Annotated[int, Field(ge=0)] = 0
    """Openings through the part that the sensor saw the background through, as in a ring."""

    @property
    def superquadric(self) -> Superquadric:
        return Superquadric.from_vector(self.parameters)


def superquadric_rows(primitives: Sequence[Primitive]) -> NDArray[np.float64]:
    """Return the parameters (P, 12) of primitives, a row each."""
    return np.array([each.parameters for each in primitives], dtype=np.float64).reshape(-1, 12)


class EmsParameters(Message):
    """How superquadrics are recovered: Table A.1 of the thesis, by name.

    Lengths and costs of a fit are in units of a tenth of the cloud's largest
    coordinate about its mean, as Liu et al. (CVPR 2022) rescale it. The limits are
    the table's ranges, widened to what still makes sense.
    """

    outlier_ratio: Annotated[float, Field(ge=0, le=0.9999)]
    """Prior probability that a point is no part of the superquadric."""
    max_iterations: Annotated[int, Field(ge=1, le=100)]
    """Rounds of expectation and maximization at most."""
    tolerance: Annotated[float, Field(ge=0, le=1)]
    """A weighted sum of squared distances below this is good enough."""
    relative_tolerance: Annotated[float, Field(ge=0, le=10)]
    """A round that lowers the cost by a smaller share than this (of the new cost)
    has settled: time for a switch, or for the end."""
    max_switches: Annotated[int, Field(ge=0, le=16)]
    """How often similar shapes are tried."""
    adaptive_upper_bound: bool
    """Bound each semi-axis by the points' reach along it."""
    eps: Annotated[float, Field(ge=1e-4, le=1)]
    """Reach of DBSCAN on the outliers, in metres."""
    min_points: Annotated[int, Field(ge=11, le=100_000)]
    """Points within reach that make a DBSCAN core point, and the fewest that a
    further superquadric is fitted to."""


PRESETS: MappingProxyType[Preset, EmsParameters] = MappingProxyType(
    {
        "simulation": EmsParameters(
            outlier_ratio=0.965,
            max_iterations=18,
            tolerance=0.00468,
            relative_tolerance=0.867,
            max_switches=2,
            adaptive_upper_bound=False,
            eps=0.0131,
            min_points=100,
        ),
        "real_world": EmsParameters(
            outlier_ratio=0.996,
            max_iterations=18,
            tolerance=0.00430,
            relative_tolerance=0.804,
            max_switches=2,
            adaptive_upper_bound=True,
            eps=0.0397,
            min_points=150,
        ),
    }
)
"""Both columns of values of Table A.1."""


class RecoverRequest(Message):
    """An object's visible points in metres, and what perception knows around it."""

    points: Points
    viewpoint: Vector3 = (0.0, 0.0, 0.0)
    plane: SupportPlane | None = None
    up: Direction | None = None
    obstacle_points: Points | None = None
    """Visible points of other things, thin as they may be. Where they are in front of the
    object, `parts` takes what they hide for unknown, neither object nor background."""
    method: Method | None = None
    """Without it, the service's own setting; `ems` where `preset` or `parameters` are given."""
    preset: Preset | None = None
    """Parameters of Table A.1; without it, the service's own setting."""
    parameters: EmsParameters | None = None
    """Instead of the preset's."""
    seed: Annotated[int, Field(ge=0, lt=2**32)] = 0


class Joint(Message):
    """Two parts that meet."""

    primitive_ids: tuple[int, int]
    position: Vector3
    """Middle of the border between their points, in metres."""


class RecoverResponse(Message):
    """The primitives, largest support first; ids count from 0."""

    primitives: tuple[Primitive, ...]
    method: Method
    removed_as_overlap: int
    """How many primitives Algorithm 2 took away."""
    point_primitive: Labels | None = None
    """Id of the part that each point was cut to, -1 for none; None where the method
    leaves that to the closest point (Eq. 5.1)."""
    joints: tuple[Joint, ...] = ()
    """Which parts meet, where the method knows."""
    covariances: Annotated[NDArray[np.float64], ArrayField("float64", ("P", 11, 11))] | None = None
    """Of each primitive's e1, e2, a1, a2, a3 (metres), tx, ty, tz (metres) and rotation
    vector in its own frame (radians), from the Jacobian of the fit."""


RECOVER = Route(
    "primitive_recovery",
    "/recover",
    RecoverRequest,
    RecoverResponse,
    "Decompose object points into superquadrics and classify their shapes",
)
