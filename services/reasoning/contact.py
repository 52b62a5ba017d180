"""Which parts of an object meet."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from services.reasoning.bodies import Bodies
from shared.schemas.primitive import Joint, Primitive
from shared.superquadric import Superquadric, radial_distance

Array = NDArray[np.float64]

TOUCHING = 0.15
"""Parts meet when the gap between their surfaces is at most this share of the smaller
part's middle extent (recovered parts may end a little before they meet) ..."""

TOUCHING_M = 0.006
"""... or at most this many metres."""

_RINGS, _SPOKES = 7, 12
_LATITUDE = np.repeat(np.linspace(-np.pi / 2, np.pi / 2, _RINGS), _SPOKES)
_LONGITUDE = np.tile(np.linspace(-np.pi, np.pi, _SPOKES, endpoint=False), _RINGS)
_DIRECTIONS = np.stack(
    [np.cos(_LATITUDE), np.cos(_LONGITUDE), np.sin(_LONGITUDE), np.sin(_LATITUDE)], axis=1
)


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
    bodies = Bodies.of(shapes)
    surfaces = _surfaces(bodies)
    middle = np.sort(bodies.full_extents, axis=1)[:, 1]
    round_about = np.linalg.norm(bodies.semi_axes, axis=1)
    pairs = []
    for one, other in itertools.combinations(range(len(shapes)), 2):
        limit = max(TOUCHING_M, TOUCHING * min(middle[one], middle[other]))
        apart = np.linalg.norm(bodies.positions[one] - bodies.positions[other])
        if apart > round_about[one] + round_about[other] + limit:
            continue
        gap = min(
            radial_distance(shapes[one], surfaces[other]).min(),
            radial_distance(shapes[other], surfaces[one]).min(),
        )
        if gap <= limit:
            pairs.append((one, other))
    return pairs


def _surfaces(bodies: Bodies) -> Array:
    """Return points (P, 84, 3) of each surface, evenly spread over the sphere of directions."""
    e1, e2 = bodies.exponents.T[:, :, None]
    ring = _power(_DIRECTIONS[:, 0], e1)
    points = np.stack(
        [
            ring * _power(_DIRECTIONS[:, 1], e2),
            ring * _power(_DIRECTIONS[:, 2], e2),
            _power(_DIRECTIONS[:, 3], e1),
        ],
        axis=-1,
    )
    own = points * bodies.semi_axes[:, None]
    return np.asarray(own @ bodies.rotations.transpose(0, 2, 1) + bodies.positions[:, None])


def _power(base: Array, exponent: Array) -> Array:
    return np.asarray(np.sign(base) * np.abs(base) ** exponent)
