"""Surface mesh and volume of a superquadric."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.special import beta

from shared.superquadric.model import Superquadric

Array = NDArray[np.float64]


def volume(superquadric: Superquadric) -> float:
    """Return the enclosed volume in cubic metres (Jaklic, Leonardis, Solina 2000, Eq. 2.60)."""
    e1, e2 = superquadric.exponents
    a1, a2, a3 = superquadric.semi_axes
    return float(2 * a1 * a2 * a3 * e1 * e2 * beta(e1 / 2 + 1, e1) * beta(e2 / 2, e2 / 2))


def surface_mesh(
    superquadric: Superquadric, rings: int = 16, segments: int = 32
) -> tuple[Array, NDArray[np.int32]]:
    """Return a closed triangle mesh of the surface, in the frame the superquadric is given in.

    Directions are spread evenly over the sphere's latitude and longitude and
    pushed out to the surface, which keeps the triangles even for small exponents.

    Parameters
    ----------
    superquadric : Superquadric
    rings, segments : int
        Number of latitudes between the poles (>= 1) and of longitudes (>= 3).

    Returns
    -------
    vertices : (rings * segments + 2, 3) array, metres
    faces : (2 * rings * segments, 3) int32 array, counter-clockwise from outside
    """
    return surface_points(superquadric, rings, segments), _sphere_faces(rings, segments)


def surface_points(superquadric: Superquadric, rings: int, segments: int) -> Array:
    """Return the vertices of `surface_mesh`."""
    ball = _directions(rings, segments)
    e1, e2 = superquadric.exponents
    with np.errstate(over="ignore"):
        flat = (np.abs(ball[:, 0]) ** (2 / e2) + np.abs(ball[:, 1]) ** (2 / e2)) ** (e2 / e1)
        reach = (flat + np.abs(ball[:, 2]) ** (2 / e1)) ** (-e1 / 2)
    return superquadric.to_outer(ball * reach[:, None] * np.asarray(superquadric.semi_axes))


@cache
def _directions(rings: int, segments: int) -> Array:
    """Return unit vectors (rings * segments + 2, 3), read-only: the poles are first and last."""
    latitude = np.linspace(-np.pi / 2, np.pi / 2, rings + 2)[1:-1]
    longitude = np.arange(segments) * (2 * np.pi / segments)
    lat, lon = (grid.ravel() for grid in np.meshgrid(latitude, longitude, indexing="ij"))
    ball = np.column_stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)])
    directions = np.vstack([[0, 0, -1], ball, [0, 0, 1]])
    directions.flags.writeable = False
    return directions


def _sphere_faces(rings: int, segments: int) -> NDArray[np.int32]:
    ring = 1 + np.arange(rings * segments).reshape(rings, segments)
    after = np.roll(ring, -1, axis=1)
    south, north = 0, rings * segments + 1
    cap_south = np.stack([np.full(segments, south), after[0], ring[0]], axis=1)
    cap_north = np.stack([np.full(segments, north), ring[-1], after[-1]], axis=1)
    low, low_after = ring[:-1].ravel(), after[:-1].ravel()
    high, high_after = ring[1:].ravel(), after[1:].ravel()
    side = np.concatenate(
        [np.stack([low, low_after, high_after], 1), np.stack([low, high_after, high], 1)]
    )
    return np.concatenate([cap_south, side, cap_north]).astype(np.int32)
