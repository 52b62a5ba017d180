"""Points to primitives by radial distance (thesis Eq. 5.1)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from services.matching.checks import check_finite
from shared.errors import InvalidInput
from shared.schemas.grasp import RegionRequest, RegionResponse
from shared.schemas.primitive import Primitive
from shared.superquadric import radial_distance

NO_PRIMITIVE = -1
_MAX_ID = int(np.iinfo(np.int16).max)
_LEAST = 1e-9


def find_region(request: RegionRequest) -> RegionResponse:
    """Say which primitive each point belongs to, and which points the chosen ones hold.

    Where the request does not say, a point belongs to the primitive whose surface
    is nearest along the ray from the primitive's centre: the smallest |radial
    distance| of Eq. 5.1. Between equals, the primitive that comes first wins.

    Raises
    ------
    InvalidInput
        Non-finite points, a primitive without a shape (zero axes, exponents or
        rotation), two primitives with one id, a chosen id that is not there, or
        assignments that do not fit the points or the primitives.
    """
    check_finite("points", request.points)
    known = _check_primitives(request.primitives)
    if missing := sorted(set(request.primitive_ids) - set(known)):
        raise InvalidInput(
            f"primitive_ids names {missing}, but the primitives are {known}",
            field="primitive_ids",
            found=missing,
            allowed=known,
        )
    owner = _given_owner(request, known)
    if owner is None:
        owner = assign_points(request.points, request.primitives)
    chosen = np.array(sorted(set(request.primitive_ids)), dtype=np.int16)
    return RegionResponse(point_primitive=owner, point_region=np.isin(owner, chosen))


def _given_owner(request: RegionRequest, known: list[int]) -> NDArray[np.int16] | None:
    owner = request.point_primitive
    if owner is None:
        return None
    if len(owner) != len(request.points):
        raise InvalidInput(
            f"point_primitive has {len(owner)} entries for {len(request.points)} points",
            field="point_primitive",
            found=len(owner),
            allowed=len(request.points),
        )
    if strangers := sorted(set(np.unique(owner).tolist()) - {NO_PRIMITIVE, *known}):
        raise InvalidInput(
            f"point_primitive names {strangers}, but the primitives are {known}",
            field="point_primitive",
            found=strangers,
            allowed=known,
        )
    return owner


def assign_points(
    points: NDArray[np.float64], primitives: Sequence[Primitive]
) -> NDArray[np.int16]:
    """Return the id (N,) of the primitive nearest to each point (N, 3), -1 without primitives."""
    owner = np.full(len(points), NO_PRIMITIVE, dtype=np.int16)
    nearest = np.full(len(points), np.inf)
    for primitive in primitives:
        distance = np.abs(radial_distance(primitive.superquadric, points))
        closer = distance < nearest
        owner[closer] = primitive.id
        nearest[closer] = distance[closer]
    return owner


def _check_primitives(primitives: Sequence[Primitive]) -> list[int]:
    known: list[int] = []
    for primitive in primitives:
        check_finite(f"primitive {primitive.id}", np.asarray(primitive.parameters))
        sizes, quaternion = primitive.parameters[:5], primitive.parameters[8:]
        if min(sizes) < _LEAST or np.linalg.norm(quaternion) < _LEAST:
            raise InvalidInput(
                f"primitive {primitive.id} has no shape: exponents and semi-axes must be "
                "positive, the quaternion non-zero",
                field="primitives",
                found=list(primitive.parameters),
            )
        if primitive.id in known or primitive.id > _MAX_ID:
            raise InvalidInput(
                f"primitive id {primitive.id} must be unique and at most {_MAX_ID}",
                field="primitives",
                found=primitive.id,
            )
        known.append(primitive.id)
    return known
