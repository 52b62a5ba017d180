"""What an object may look like all round, by the points that were seen of it.

A superquadric is round where a bottle's cap is a cone, and straight where a handle swells. The
points that were seen are none of this, but half of them is missing. Objects are mostly
symmetric: a part's missing half is the seen one, reflected away from the sensor. That is not
true, nor is the superquadric, but what holds both is likely to hold the object
(docs/decisions/0032-rehearsal.md).
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from functools import cache, lru_cache

import numpy as np
from numpy.typing import NDArray

from services.execution.convex import ConvexPart, convex_hull
from shared.geometry.points import principal_axes
from shared.geometry.rotation import unit
from shared.superquadric import Superquadric, radial_distance

Array = NDArray[np.float64]

SLAB = 0.02
"""Metres along the axis: a part is cut into convex slabs of about this, so that it may taper."""
OVERLAP = 0.002
"""Metres by which neighbouring slabs share points."""
FEWEST = 10
"""Points that make a slab."""
DIRECTIONS = 100
"""A slab's hull is made of its outermost points in so many directions, evenly spread."""
LONG = 1.5
"""A part is long, or flat, whose axis is so many times the next one, or the next so many times
it; the axis of others is the object's."""
ASIDE = 0.2
"""Below this share across the axis, the sensor looks along it."""
TAIL = 0.5
"""Per cent of the points at either end of a part that may be strays."""


def completed(
    points: Array, vectors: Sequence[Sequence[float]], viewpoint: Array
) -> list[ConvexPart]:
    """Return the convex parts of an object (N, 3) whose superquadrics are known; maybe none.

    Parameters
    ----------
    points : (N, 3) array
    vectors : sequence of sequence of float
        Of Eq. 3.3; each point belongs to the one whose surface is nearest.
    viewpoint : (3,) array
        Of the sensor.
    """
    held = np.ascontiguousarray(points)
    rows = np.asarray(vectors, dtype=np.float64)
    return list(_completed(held.tobytes(), rows.tobytes(), viewpoint.tobytes()))


@lru_cache(maxsize=8)
def _completed(points: bytes, vectors: bytes, viewpoint: bytes) -> tuple[ConvexPart, ...]:
    seen = np.frombuffer(points).reshape(-1, 3)
    bodies = [Superquadric.from_vector(row) for row in np.frombuffer(vectors).reshape(-1, 12)]
    nearest = np.argmin([np.abs(radial_distance(body, seen)) for body in bodies], axis=0)
    _, axes = principal_axes(seen)
    parts: list[ConvexPart] = []
    for index, body in enumerate(bodies):
        own = seen[nearest == index] - body.position
        if len(own) >= FEWEST:
            axis = _axis(body, axes[:, 0])
            sight = unit(body.position - np.frombuffer(viewpoint))
            both = np.vstack([own, _reflected(own, axis, sight)])
            parts += _slabs(both + body.position, axis)
    return tuple(parts)


def _axis(body: Superquadric, object_axis: Array) -> Array:
    """Return the direction (3,) along which a part keeps its cross-section best."""
    order = np.argsort(body.semi_axes)
    shortest, middle, longest = np.asarray(body.semi_axes)[order]
    if longest > LONG * middle:
        return np.asarray(body.rotation[:, order[2]])
    if middle > LONG * shortest:
        return np.asarray(body.rotation[:, order[0]])
    return object_axis


def _reflected(own: Array, axis: Array, sight: Array) -> Array:
    """Return points (N, 3) about a part's centre as they are on its other side."""
    across = sight - (sight @ axis) * axis
    away = unit(across) if np.linalg.norm(across) > ASIDE else sight
    return np.asarray(own - 2 * (own @ away)[:, None] * away)


def _slabs(points: Array, axis: Array) -> list[ConvexPart]:
    """Return the hulls of points (N, 3) between cuts across the axis."""
    place = points @ axis
    low, high = np.percentile(place, [TAIL, 100 - TAIL])
    cuts = np.linspace(low, high, max(1, round((high - low) / SLAB)) + 1)
    hulls = []
    for begin, end in itertools.pairwise(cuts):
        slab = points[(place >= begin - OVERLAP) & (place <= end + OVERLAP)]
        if len(slab) >= FEWEST:
            hulls.append(convex_hull(_outermost(slab)))
    return [hull for hull in hulls if hull is not None]


def _outermost(points: Array) -> Array:
    """Return those of the points (N, 3) that lie furthest out in some direction."""
    return np.asarray(points[np.unique((points @ _directions().T).argmax(axis=0))])


@cache
def _directions() -> Array:
    """Return unit vectors (D, 3) on a Fibonacci lattice."""
    index = np.arange(DIRECTIONS) + 0.5
    height, turn = 1 - 2 * index / DIRECTIONS, np.pi * (1 + 5**0.5) * index
    level = np.sqrt(1 - height**2)
    return np.column_stack([level * np.cos(turn), level * np.sin(turn), height])
