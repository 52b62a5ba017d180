"""What the sensor could not see: space behind the visible surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import minimum_filter
from scipy.spatial import cKDTree

from shared.geometry.rotation import frame_from_z
from shared.jit import kernel

Array = NDArray[np.float64]

_MAX_CELLS = 512
TOLERANCE = 0.004
_PROBES = 500
_LEAST_AHEAD = 1e-6


@dataclass(frozen=True)
class SightMap:
    """A coarse range image of the surface, as the sensor saw it.

    Attributes
    ----------
    view_from_work : (3, 3) array
        Rotation into the sensor's frame, z ahead.
    viewpoint : (3,) array
    nearest : (H, W) array
        Depth of the nearest surface per cell, inf where there is none.
    corner : (2,) array
        Tangents of the first cell.
    cell : float
        Size of a cell, as a tangent.
    """

    view_from_work: Array
    viewpoint: Array
    nearest: Array
    corner: Array
    cell: float

    @classmethod
    def of(cls, points: Array, viewpoint: Array) -> SightMap:
        """Draw the surface points (N, 3) with cells twice as wide as their spacing."""
        view_from_work = frame_from_z(points.mean(axis=0) - viewpoint).T
        seen = (points - viewpoint) @ view_from_work.T
        flat = seen[:, :2] / seen[:, 2:]
        some = flat[:: max(1, len(flat) // _PROBES)]
        tree = cKDTree(flat, compact_nodes=False, balanced_tree=False)  # built faster
        spacing = np.asarray(tree.query(some, k=2)[0])
        low, high = flat.min(axis=0), flat.max(axis=0)
        cell = max(
            2 * float(np.median(spacing[:, 1])), float((high - low).max()) / _MAX_CELLS, 1e-9
        )
        columns, rows = (np.floor((high - low) / cell).astype(np.int64) + 3).tolist()
        nearest = np.full(rows * columns, np.inf)
        corner = low - cell
        u, v = np.floor((flat - corner) / cell).astype(np.int64).T
        np.minimum.at(nearest, v * columns + u, seen[:, 2])
        image = minimum_filter(nearest.reshape(rows, columns), size=3, mode="constant", cval=np.inf)
        return cls(view_from_work, viewpoint, image, corner, cell)

    def depth_behind(self, points: Array) -> Array:
        """Return how far points (..., 3) lie behind the visible surface, metres.

        Zero where the sensor saw them free: in front of the surface or beside it.
        """
        seen = (points - self.viewpoint).reshape(-1, 3) @ self.view_from_work.T
        return _behind(seen, self.nearest, self.corner, self.cell).reshape(points.shape[:-1])


@kernel
def _behind(seen: Array, nearest: Array, corner: Array, cell: float) -> Array:
    """Return how far points (N, 3) in the sensor's frame lie behind the map's surface."""
    behind = np.zeros(len(seen))
    rows, columns = nearest.shape
    for n in range(len(seen)):
        x, y, ahead = seen[n]
        if not ahead > _LEAST_AHEAD:
            continue
        u, v = np.floor((x / ahead - corner[0]) / cell), np.floor((y / ahead - corner[1]) / cell)
        if 0 <= u < columns and 0 <= v < rows:
            behind[n] = max(ahead - nearest[int(v), int(u)] - TOLERANCE, 0.0)
    return behind
