"""A plane in a view: the piece of it that was seen, and its fit to all of its points."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from services.perception.cloud import cluster
from services.perception.median import median
from services.perception.moments import biweight_moments
from services.perception.noise import SIGMA_PER_MEDIAN
from services.perception.settings import PerceptionSettings
from shared.geometry.passes import about_mean
from shared.geometry.plane import height_above, plane_basis
from shared.geometry.points import tail_signs

Array = NDArray[np.float64]

SAMPLE = 20_000
"""Points that speak for a view where not all are needed."""
MAP_VOXEL_M = 0.015
"""Edge of the voxels of the thinned cloud in which planes are searched."""
MIN_SHARE = 0.05
"""Of a view; a plane with less of it is no candidate for the support."""
_FEW, _MANY = 5_000, 60_000
_MIN_WIDTH_M = 0.06
_PATCH_GAP_M = 0.1
_COMPASS = np.stack([f(np.arange(32) * np.pi / 16) for f in (np.cos, np.sin)])
_TUKEY = 4.685
"""Cut-off of Tukey's biweight, in standard deviations: 95 % efficient on normal noise."""


@dataclass(frozen=True)
class Plane:
    """A flat surface, `normal . p + offset = 0`, and the piece of it that was seen.

    Attributes
    ----------
    normal : (3,) array
        Unit vector towards the sensor.
    offset : float
        Metres.
    basis : (3, 2) array
        Orthonormal directions in the plane: the principal axes of the seen piece.
    outline : (32,) array
        How far the seen piece extends in 32 evenly spread directions of the plane,
        measured from the frame's origin: half-planes that enclose it.
    box : (2, 2) array
        Least and largest u, v of the seen piece.
    share : float
        Part of the view's points that lie on it.
    area : float
        Square metres seen.
    width, length : float
        Sides of `box`.
    """

    normal: Array
    offset: float
    basis: Array
    outline: Array
    box: Array
    share: float
    area: float
    width: float
    length: float

    def heights(self, points: Array) -> Array:
        """Return signed distances (N,) of points (N, 3) towards the sensor."""
        return height_above(points, self.normal, self.offset)

    def carries(self, points: Array, margin: float) -> NDArray[np.bool_]:
        """Tell which points (N, 3) stand over the seen piece, give or take `margin`."""
        reach = self.outline + margin
        return np.asarray(((points @ self.basis) @ _COMPASS <= reach).all(axis=1))


def measure_plane(normal: Array, offset: float, mapped: Array, share: float) -> Plane | None:
    """Return the plane seen at the points `mapped` of the thinned cloud.

    Patches of less than a tenth of them are left out: where a wall crosses the level of a
    table. None when the rest is too small to stand on, or `share` of the view is.
    """
    if share < MIN_SHARE:
        return None
    patches = cluster(mapped, _PATCH_GAP_M, 1)
    sizes = np.bincount(patches)
    mapped = mapped.compress((sizes >= 0.1 * sizes.sum())[patches], axis=0)
    if len(mapped) < 3:
        return None
    basis = plane_basis(normal)
    basis = basis @ np.linalg.eigh(np.cov(basis.T @ mapped.T))[1]
    uv = basis.T @ mapped.T  # one row each: NumPy reduces rows many times faster than columns
    signs = tail_signs((uv - uv.mean(axis=1, keepdims=True)).T)
    basis, uv = basis * signs, uv * signs[:, None]
    box = np.array([uv.min(axis=1), uv.max(axis=1)])
    width, length = np.sort(box[1] - box[0]).tolist()
    if width < _MIN_WIDTH_M:
        return None
    area = len(mapped) * MAP_VOXEL_M**2
    outline = (_COMPASS.T @ uv).max(axis=1)
    return Plane(normal, offset, basis, outline, box, share, area, width, length)


def refine(plane: Plane, points: Array, settings: PerceptionSettings) -> Plane:
    """Return `plane` fitted to all of its points by least squares with Tukey's biweight.

    Objects on the plane and what is cut off by it lie beyond the biweight's reach, which
    follows the scatter of the points, so they do not tilt it. The first steps run on a
    few points, the last one on at most 60,000 or so.
    """
    reach = 2 * settings.plane_tolerance_m
    few = points.take(np.arange(0, len(points), max(1, len(points) // _FEW)), axis=0)
    few = few.compress(np.abs(plane.heights(few)) < reach, axis=0)
    if len(few) < 3:
        return plane
    origin, _ = about_mean(few)
    offset = plane.offset + float(plane.normal @ origin)
    normal = np.ascontiguousarray(plane.normal)
    last_step = max(1, len(points) // _MANY)
    for cloud, step in ((few, 1), (few, 1), (few, 1), (points, last_step)):
        heights = np.abs(height_above(few, normal, offset - float(normal @ origin)))
        near = heights[heights < reach]
        spread = median(near) if len(near) else 0.0
        scale = _TUKEY * max(SIGMA_PER_MEDIAN * spread, 2e-4)
        total, mean, scatter = biweight_moments(cloud, step, origin, normal, offset, scale)
        if total < 3.0:
            return plane
        turned = np.linalg.eigh(scatter)[1][:, 0].copy()
        normal = turned if turned @ normal > 0 else -turned
        offset = -float(normal @ mean)
    return replace(plane, normal=normal, offset=offset - float(normal @ origin))
