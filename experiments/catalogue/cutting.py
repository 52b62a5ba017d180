"""A surface cut along planes, so that every triangle lies on one side of each."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def cut(vertices: Array, faces: Indices, axis: int, value: float) -> tuple[Array, Indices]:
    """Return the surface with its triangles cut where they cross a plane.

    Both triangles at an edge get the same new vertex, so a closed surface stays
    closed.

    Parameters
    ----------
    vertices : (V, 3) array
        Any unit.
    faces : (F, 3) array
        Rows of `vertices`.
    axis, value : int, float
        The plane where this coordinate has this value.
    """
    distance = vertices[:, axis] - value
    distance[np.abs(distance) < 1e-9 * max(float(np.ptp(vertices[:, axis])), 1e-300)] = 0.0
    side = np.sign(distance)[faces]
    crossing = (side.min(axis=1) < 0) & (side.max(axis=1) > 0)
    if not crossing.any():
        return vertices, faces
    across, side = faces[crossing], side[crossing]
    # turn each triangle until its odd corner comes first: the one on the plane, or
    # else the one that is alone on its side
    touches = (side == 0).any(axis=1)
    odd = (side != np.sign(side.sum(axis=1))[:, None]).argmax(axis=1)
    alone = np.where(touches, (side == 0).argmax(axis=1), odd)
    order = (alone[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(across, order, axis=1).T
    ends = np.concatenate(
        [
            np.column_stack([b, c])[touches],
            np.column_stack([a, b])[~touches],
            np.column_stack([a, c])[~touches],
        ]
    )
    edges, which = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
    share = distance[edges[:, 0]] / (distance[edges[:, 0]] - distance[edges[:, 1]])
    points = vertices[edges[:, 0]] + share[:, None] * (
        vertices[edges[:, 1]] - vertices[edges[:, 0]]
    )
    points[:, axis] = value
    new = len(vertices) + which.reshape(-1)
    through, beside = np.count_nonzero(touches), np.count_nonzero(~touches)
    middle, one, other = new[:through], new[through : through + beside], new[through + beside :]
    at, bt, ct = a[touches], b[touches], c[touches]
    an, bn, cn = a[~touches], b[~touches], c[~touches]
    pieces = [
        faces[~crossing],
        np.column_stack([at, bt, middle]),
        np.column_stack([at, middle, ct]),
        np.column_stack([an, one, other]),
        np.column_stack([one, bn, cn]),
        np.column_stack([one, cn, other]),
    ]
    return np.concatenate([vertices, points]), np.concatenate(pieces)
