"""The smallest box around points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from shared.geometry.rotation import frame_from_z

Array = NDArray[np.float64]

SAME_NORMAL = 0.05
"""Facets whose normals round to the same multiples of this are tried once, the largest."""


@dataclass(frozen=True)
class Box:
    """A box in any orientation.

    Attributes
    ----------
    lengths : (3,) array
        Of its edges, ascending, metres.
    centre : (3,) array
    axes : (3, 3) array
        Columns: directions of the edges, in the order of their lengths; right-handed.
    """

    lengths: Array
    centre: Array
    axes: Array

    def local(self, points: Array) -> Array:
        """Return points (N, 3) in its frame, where it reaches from -1 to 1 along each axis."""
        return np.asarray(2 * ((points - self.centre) @ self.axes) / self.lengths)


def smallest_box(points: Array) -> Box:
    """Return a small box around points (N, 3).

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
    smallest, best = np.inf, None
    for normal in _normals(hull):
        frame = frame_from_z(normal)
        local = corners @ frame
        lengths, centre, across = _smallest_rectangle(local[:, :2])
        low, high = local[:, 2].min(), local[:, 2].max()
        volume = float(lengths.prod() * (high - low))
        if volume < (1 - 1e-6) * smallest:  # of mirrored ones, the first
            smallest = volume
            edges = np.array([*lengths, high - low])
            order = np.argsort(edges, kind="stable")
            axes = np.column_stack([frame[:, :2] @ across.T, frame[:, 2]])[:, order]
            axes[:, 2] *= np.sign(np.linalg.det(axes))
            best = Box(edges[order], frame @ [*centre, (low + high) / 2], axes)
    assert best is not None
    return best


def _normals(hull: ConvexHull) -> Array:
    """Return normals (K, 3) of facets; of those that are nearly alike, the largest facet's."""
    a, b, c = (hull.points[hull.simplices[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    normals = hull.equations[:, :3][np.argsort(-area, kind="stable")]
    rounded = np.round(normals / SAME_NORMAL)
    sign = np.sign(rounded[np.arange(len(rounded)), np.abs(rounded).argmax(axis=1)])
    _, first = np.unique(rounded * sign[:, None], axis=0, return_index=True)
    return np.asarray(normals[np.sort(first)])


def _smallest_rectangle(points: Array) -> tuple[Array, Array, Array]:
    """Return edge lengths (2,), centre (2,) and directions of the edges (2, 2), one a row.

    Of the smallest rectangle around points (N, 2).

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
    directions = np.stack([along[edge], across[edge]])
    return high[edge] - low[edge], middle @ directions, directions
