"""DBSCAN on dense clouds, at the cost of sparse ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from sklearn.cluster import DBSCAN

Array = NDArray[np.float64]

CELLS_PER_EPS = 8


def dense_clusters(points: Array, eps: float, min_points: int) -> list[NDArray[np.int64]]:
    """Return the clusters of points (N, 3) as index arrays, largest first.

    A depth image has hundreds of points within `eps` of each other, and DBSCAN
    lists all such pairs. So the points are first gathered in cubic cells of
    eps / 8; DBSCAN runs on the cells' means, each with as much weight as it has
    points. A distance is off by at most a cell's diagonal, which moves points at
    the rim of a cluster and leaves the clusters.

    Parameters
    ----------
    points : (N, 3) array
        In a frame that moves with them: the cells lie along its axes.
    eps : float
        Reach, in the unit of the points.
    min_points : int
        Weight within reach that makes a core point; smaller clusters are dropped.
    """
    if len(points) < min_points:
        return []
    cells = np.floor(points / (eps / CELLS_PER_EPS)).astype(np.int64)
    _, cell_of_point, counts = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
    cell_of_point = cell_of_point.reshape(-1)
    means = np.column_stack(
        [np.bincount(cell_of_point, weights=points[:, k]) / counts for k in range(3)]
    )
    model = DBSCAN(eps=eps, min_samples=min_points, algorithm="kd_tree")
    label = model.fit_predict(means, sample_weight=counts)[cell_of_point]
    found = [np.flatnonzero(label == k) for k in range(label.max() + 1)]
    kept = [indices for indices in found if len(indices) >= min_points]
    return sorted(kept, key=len, reverse=True)
