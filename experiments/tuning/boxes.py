"""The smallest box around points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from shared.geometry.rotation import frame_from_z

Array = NDArray[np.float64]

SAME_NORMAL = 0.05
"""Facets whose normals round to the same multiples of this are tried once, the largest."""


def smallest_box(points: Array) -> tuple[Array, Array]:
    """Return edge lengths (3,), ascending, and centre (3,) of a box around points (N, 3).

    The smallest of those with a face on a facet of the convex hull, and an edge
    along an edge of the hull's shadow on that face (O'Rourke, 1985, shows that the
    smallest of all has two faces on edges of the hull; what is lost is little).

    Raises
    ------
    scipy.spatial.QhullError
        All points lie on a plane.
    """
    hull = ConvexHull(points)
    corners = hull.points[hull.vertices]
    best = (np.inf, np.zeros(3), np.zeros(3))
    for normal in _normals(hull):
        frame = frame_from_z(normal)
        local = corners @ frame
        lengths, centre = _smallest_rectangle(local[:, :2])
        low, high = local[:, 2].min(), local[:, 2].max()
        volume = float(lengths.prod() * (high - low))
        if volume < (1 - 1e-6) * best[0]:  # of mirrored ones, the first
            edges = np.sort([*lengths, high - low])
            best = (volume, edges, frame @ [*centre, (low + high) / 2])
    return best[1], best[2]


def _normals(hull: ConvexHull) -> Array:
    """Return normals (K, 3) of facets; of those that are nearly alike, the largest facet's."""
    a, b, c = (hull.points[hull.simplices[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    normals = hull.equations[:, :3][np.argsort(-area, kind="stable")]
    rounded = np.round(normals / SAME_NORMAL)
    sign = np.sign(rounded[np.arange(len(rounded)), np.abs(rounded).argmax(axis=1)])
    _, first = np.unique(rounded * sign[:, None], axis=0, return_index=True)
    return np.asarray(normals[np.sort(first)])


def _smallest_rectangle(points: Array) -> tuple[Array, Array]:
    """Return edge lengths (2,) and centre (2,) of the smallest rectangle around points (N, 2).

    One of its edges lies on an edge of their convex hull (Freeman and Shapira, 1975).
    """
    outline = points[ConvexHull(points).vertices]
    along = np.roll(outline, -1, axis=0) - outline
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    across = np.column_stack([-along[:, 1], along[:, 0]])
    reach = np.stack([along, across], axis=1) @ outline.T  # edge, direction, corner
    low, high = reach.min(axis=2), reach.max(axis=2)
    edge = int((high - low).prod(axis=1).argmin())
    middle = (low[edge] + high[edge]) / 2
    return high[edge] - low[edge], middle @ np.stack([along[edge], across[edge]])
