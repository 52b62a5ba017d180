"""Open3D on plain arrays: thinning and density clustering. Deterministic, no global state."""

from __future__ import annotations

import numpy as np
import open3d as o3d
from numpy.typing import NDArray

Array = NDArray[np.float64]
Labels = NDArray[np.int32]


def thin(points: Array, voxel: float) -> Array:
    """Return the mean point of each occupied voxel of edge `voxel` (metres), shape (V, 3)."""
    if len(points) == 0:
        return np.empty((0, 3))
    return np.asarray(_cloud(points).voxel_down_sample(voxel).points).copy()


def cluster(points: Array, gap: float, min_neighbours: int) -> Labels:
    """Return DBSCAN labels (N,) of points (N, 3), -1 for noise, thinned to `gap / 2` first.

    Parameters
    ----------
    points : (N, 3) array
        Metres.
    gap : float
        Points closer than this are neighbours.
    min_neighbours : int
        Occupied voxels within `gap`, itself among them, that make a voxel dense.
    """
    if len(points) == 0:
        return np.empty(0, dtype=np.int32)
    cells = np.floor((points - points.min(axis=0)) / (gap / 2)).astype(np.int64)
    strides = np.cumprod(np.concatenate([[1], cells.max(axis=0)[:0:-1] + 1]))[::-1]
    _, voxel, count = np.unique(cells @ strides, return_inverse=True, return_counts=True)
    centres = np.column_stack(
        [np.bincount(voxel, weights=points[:, axis]) / count for axis in range(3)]
    )
    labels = np.asarray(_cloud(centres).cluster_dbscan(gap, min_neighbours), dtype=np.int32)
    return np.asarray(labels[voxel], dtype=np.int32)


def _cloud(points: Array) -> o3d.geometry.PointCloud:
    return o3d.geometry.PointCloud(o3d.utility.Vector3dVector(np.ascontiguousarray(points)))
