"""Where something nearer hides whatever lies behind: neither object nor background."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import ConvexHull, cKDTree

from services.primitive_recovery.parts.grid import bridged, cell_means, nearest_of
from services.primitive_recovery.parts.projection import Projection
from services.primitive_recovery.parts.silhouette import Silhouette

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

NEARER = 3.0
"""Cells by which something must be nearer than the object beside it to hide it."""
BLEED = 1
"""Cells that something hides beyond its points: at a step of depth sensors lose pixels."""
CONVEX = 0.95
"""Share of its convex hull that a convex picture fills: cells are coarse, edges noisy."""

_QUARTERS = np.array([[-0.25, -0.25], [-0.25, 0.25], [0.25, -0.25], [0.25, 0.25]])


@dataclass(frozen=True)
class Hidden:
    """The hidden cells of a silhouette's picture.

    Attributes
    ----------
    mask : (H, W) bool array
        Hidden cells; none of them shows the object.
    front, behind : (U, 3) array
        For each of them the point of what hides it, and the point on the same ray as far
        away as the nearest visible part of the object; metres, about the mean of the
        object's points.
    """

    mask: Mask
    front: Array
    behind: Array

    @property
    def is_empty(self) -> bool:
        return not len(self.front)


def hidden_by(
    others: Array | None, picture: Silhouette, seen_by: Projection, ahead: Array
) -> Hidden:
    """Return what other things hide in the picture of an object.

    Parameters
    ----------
    others : (M, 3) array or None
        Points of other things about the mean of the object's, as thin as they may be: each
        hides what lies within the distance of neighbours.
    picture : Silhouette
        Of the object.
    seen_by : Projection
        Into the picture; of a parallel one the sensor is unknown, so nothing hides anything.
    ahead : (N,) array
        Depth of each of the object's points.
    """
    nothing = Hidden(np.zeros_like(picture.mask), np.empty((0, 3)), np.empty((0, 3)))
    if others is None or seen_by.eye is None:
        return nothing
    others = others[(others - seen_by.eye) @ seen_by.frame[:, 2] > 0]
    if len(others) < 2:
        return nothing
    places, depth = seen_by.placed(others)
    cells = picture.cells_of(places)
    reach = _spacing(others) / depth / picture.side + BLEED
    inside = (cells > -reach[:, None] - 1) & (cells < np.array(picture.mask.shape) + reach[:, None])
    inside = inside.all(axis=1) & (depth < float(ahead.max()))
    if not inside.any():
        return nothing
    front = nearest_of(
        picture.mask,
        np.ascontiguousarray(cells[inside]),
        np.ceil(reach[inside]).astype(np.intp),
        np.ascontiguousarray(depth[inside]),
    )
    object_depth = cell_means(picture.mask, picture.row, picture.column, ahead)
    farthest = object_depth[picture.mask].max()
    if not (front[~picture.mask] < farthest - NEARER * picture.cell).any():
        return nothing
    beside = ndimage.distance_transform_edt(
        ~picture.mask, return_distances=False, return_indices=True
    )
    object_depth = object_depth[beside[0], beside[1]]
    mask = (front < object_depth - NEARER * picture.cell) & ~picture.mask
    places = picture.middles(np.argwhere(mask))
    return Hidden(
        mask, seen_by.lifted(places, front[mask]), seen_by.lifted(places, object_depth[mask])
    )


def bridges(hidden: Hidden, picture: Silhouette, seen_by: Projection, ahead: Array) -> Array:
    """Return points (B, 3) of an object where it goes on behind what hides it, about its mean.

    Hidden cells belong to it if a straight line through hidden cells alone leads to the
    object on both sides; their depth is between those of its ends. They are as dense as
    the object's own points.

    Parameters
    ----------
    hidden : Hidden
    picture, seen_by, ahead
        As in `hidden_by`.
    """
    if hidden.is_empty:
        return np.empty((0, 3))
    depth = bridged(
        picture.mask, hidden.mask, cell_means(picture.mask, picture.row, picture.column, ahead)
    )
    return _dense(np.argwhere(depth > 0), depth[depth > 0], picture, seen_by)


def fillings(hidden: Hidden, picture: Silhouette, seen_by: Projection) -> list[Array]:
    """Return points (F, 3) of a simple object where it is hidden, about its mean, in two ways.

    Hidden cells inside the convex hull of the visible ones, and those inside their box along
    the hull's principal axes; as far away as the nearest visible ones and as dense as the
    object's own points. Only where the picture is convex with them.
    """
    cells = np.argwhere(hidden.mask)
    if not len(cells):
        return []
    corners = _corners(np.argwhere(picture.mask))
    planes = ConvexHull(corners).equations
    in_hull = (cells @ planes[:, :2].T + planes[:, 2] <= 0).all(axis=1)
    hull = np.vstack([corners, cells[in_hull]])
    axes = np.linalg.eigh(np.cov(hull.T))[1]
    placed, edges = cells @ axes, corners @ axes
    in_box = ((placed >= edges.min(axis=0)) & (placed <= edges.max(axis=0))).all(axis=1)
    _, depth = seen_by.placed(hidden.behind)
    return [
        _dense(cells[inside], depth[inside], picture, seen_by)
        for inside in (in_hull, in_box)
        if inside.any() and _is_convex(np.vstack([corners, _corners(cells[inside])]))
    ]


def _corners(cells: NDArray[np.intp]) -> Array:
    """Return the corners (4 C, 2) of cells (C, 2)."""
    return np.asarray((cells[:, None, :] + 2 * _QUARTERS).reshape(-1, 2))


def _is_convex(corners: Array) -> bool:
    """Whether cells with these corners (4 C, 2) fill nearly all of their convex hull."""
    return len(corners) / 4 >= CONVEX * float(ConvexHull(corners).volume)


def _dense(
    cells: NDArray[np.intp], depth: Array, picture: Silhouette, seen_by: Projection
) -> Array:
    """Return points in cells (C, 2) at depths (C,), about as many as an object has there."""
    places = picture.middles((cells[:, None, :] + _QUARTERS).reshape(-1, 2))
    return seen_by.lifted(places, np.repeat(depth, len(_QUARTERS)))


def _spacing(points: Array) -> float:
    """Return the median distance of points (M, 3) to the nearest other one."""
    distance = np.asarray(cKDTree(points).query(points, k=2)[0])
    return float(np.median(distance[:, 1]))
