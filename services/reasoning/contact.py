"""Which parts of an object meet."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from shared.schemas.primitive import Joint, Primitive
from shared.superquadric import Superquadric, radial_distance

Array = NDArray[np.float64]

TOUCHING = 0.15
"""Parts meet when the gap between their surfaces is at most this share of the smaller
part's middle extent (recovered parts may end a little before they meet) ..."""

TOUCHING_M = 0.006
"""... or at most this many metres."""

_RINGS, _SPOKES = 7, 12
_LATITUDE = np.linspace(-np.pi / 2, np.pi / 2, _RINGS)[:, None]
_LONGITUDE = np.linspace(-np.pi, np.pi, _SPOKES, endpoint=False)[None, :]


def touching(
    primitives: Sequence[Primitive], joints: Sequence[Joint]
) -> tuple[tuple[int, int], ...]:
    """Return the pairs of parts that meet, as indices into `primitives`, the smaller first.

    Where the recovery names joints they decide; otherwise parts meet whose
    surfaces come close or overlap.
    """
    if not joints:
        return tuple(_meeting([primitive.superquadric for primitive in primitives]))
    index = {primitive.id: number for number, primitive in enumerate(primitives)}
    named = (joint.primitive_ids for joint in joints)
    pairs = ((index[a], index[b]) for a, b in named if a in index and b in index)
    return tuple(sorted({(min(pair), max(pair)) for pair in pairs if pair[0] != pair[1]}))


def _meeting(shapes: Sequence[Superquadric]) -> list[tuple[int, int]]:
    surfaces = [_surface(shape) for shape in shapes]
    middle = [float(np.sort(shape.full_extents)[1]) for shape in shapes]
    pairs = []
    for one in range(len(shapes)):
        for other in range(one + 1, len(shapes)):
            limit = max(TOUCHING_M, TOUCHING * min(middle[one], middle[other]))
            gap = min(
                radial_distance(shapes[one], surfaces[other]).min(),
                radial_distance(shapes[other], surfaces[one]).min(),
            )
            if gap <= limit:
                pairs.append((one, other))
    return pairs


def _surface(shape: Superquadric) -> Array:
    """Return points (84, 3) of the surface, evenly spread over the sphere of directions."""
    e1, e2 = shape.exponents
    ring = _power(np.cos(_LATITUDE), e1)
    points = np.stack(
        [
            ring * _power(np.cos(_LONGITUDE), e2),
            ring * _power(np.sin(_LONGITUDE), e2),
            np.broadcast_to(_power(np.sin(_LATITUDE), e1), (_RINGS, _SPOKES)),
        ],
        axis=-1,
    )
    return shape.to_outer(points.reshape(-1, 3) * np.array(shape.semi_axes))


def _power(base: Array, exponent: float) -> Array:
    return np.sign(base) * np.abs(base) ** exponent
