"""Thinning and density clustering of points. Deterministic, no global state."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from services.perception.voxels import voxel_means
from shared.jit import kernel

Array = NDArray[np.float64]
Labels = NDArray[np.int32]

_NONE = -1


def thin(points: Array, voxel: float) -> Array:
    """Return the mean point of each occupied voxel of edge `voxel` (metres), shape (V, 3)."""
    return voxel_means(points, voxel)[0]


def cluster(points: Array, gap: float, min_neighbours: int) -> Labels:
    """Return DBSCAN labels (N,) of points (N, 3), -1 for noise, thinned to `gap / 2` first.

    Ester et al. (KDD 1996). A point between two clusters goes to the first of them.

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
    centres, voxel = voxel_means(points, gap / 2)
    pairs = cKDTree(centres).query_pairs(gap, output_type="ndarray")
    labels = _density_labels(len(centres), np.asarray(pairs, dtype=np.int64), min_neighbours)
    return np.asarray(labels[voxel])


@kernel
def _density_labels(number: int, pairs: NDArray[np.int64], min_neighbours: int) -> Labels:
    """Return the DBSCAN label of each of `number` points whose neighbours are `pairs` (P, 2)."""
    degree = np.ones(number, dtype=np.int32)
    for k in range(len(pairs)):
        degree[pairs[k, 0]] += 1
        degree[pairs[k, 1]] += 1
    parent = np.arange(number)
    for k in range(len(pairs)):
        a, b = pairs[k, 0], pairs[k, 1]
        if degree[a] < min_neighbours or degree[b] < min_neighbours:
            continue
        while parent[a] != a:
            parent[a] = parent[parent[a]]
            a = parent[a]
        while parent[b] != b:
            parent[b] = parent[parent[b]]
            b = parent[b]
        parent[max(a, b)] = min(a, b)
    labels = np.full(number, _NONE, dtype=np.int32)
    clusters = 0
    for i in range(number):
        if degree[i] < min_neighbours:
            continue
        root = i
        while parent[root] != root:
            root = parent[root]
        if labels[root] == _NONE:  # the root is the first point of its cluster
            labels[root] = clusters
            clusters += 1
        labels[i] = labels[root]
    for k in range(len(pairs)):
        for end in range(2):
            edge, core = pairs[k, end], pairs[k, 1 - end]
            if degree[edge] >= min_neighbours or degree[core] < min_neighbours:
                continue
            if labels[edge] == _NONE or labels[core] < labels[edge]:
                labels[edge] = labels[core]
    return labels
