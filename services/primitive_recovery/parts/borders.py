"""Where parts meet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from services.primitive_recovery.parts.silhouette import Silhouette

Array = NDArray[np.float64]

_FEWEST = 2
"""Neighbouring cells that make a border."""


@dataclass(frozen=True)
class PartJoint:
    """Two parts that meet.

    Attributes
    ----------
    parts : tuple of int
        The two, smaller first.
    position : (3,) array
        Middle of the border between their points, metres.
    """

    parts: tuple[int, int]
    position: Array


def joints_of(
    points: Array, picture: Silhouette, labels: NDArray[np.int16]
) -> tuple[PartJoint, ...]:
    """Return which parts of points (N, 3) meet in the picture, and where.

    A part that touches no other, as where something hides the border, is joined
    to the one that comes closest.
    """
    count = int(labels.max()) + 1
    found: list[PartJoint] = []
    if count == 1:
        return ()
    part = np.full(picture.mask.shape, -1, dtype=np.int16)
    part[picture.row, picture.column] = labels
    linked = np.zeros((count, count), dtype=bool)
    cells: dict[tuple[int, int], list[NDArray[np.intp]]] = {}
    for one, other in (
        (part[:-1], part[1:]),
        (part[:, :-1], part[:, 1:]),
    ):
        down = 1 if one.shape[0] < part.shape[0] else 0
        rows, columns = np.nonzero((one >= 0) & (other >= 0) & (one != other))
        a, b = one[rows, columns], other[rows, columns]
        for i in range(count):
            for j in range(i + 1, count):
                here = ((a == i) & (b == j)) | ((a == j) & (b == i))
                if here.any():
                    r, c = rows[here], columns[here]
                    flat = np.concatenate(
                        [r * part.shape[1] + c, (r + down) * part.shape[1] + c + 1 - down]
                    )
                    cells.setdefault((i, j), []).append(flat)
    of_point = picture.row * part.shape[1] + picture.column
    for pair, lists in sorted(cells.items()):
        border = np.unique(np.concatenate(lists))
        if len(border) >= _FEWEST:
            found.append(PartJoint(pair, points[np.isin(of_point, border)].mean(axis=0)))
            linked[pair] = linked[pair[::-1]] = True
    for lonely in np.flatnonzero(~linked.any(axis=1)):
        if not linked[lonely].any():
            joint = _closest(points, labels, int(lonely))
            found.append(joint)
            linked[joint.parts] = linked[joint.parts[::-1]] = True
    return tuple(found)


def _closest(points: Array, labels: NDArray[np.int16], lonely: int) -> PartJoint:
    own, rest = np.flatnonzero(labels == lonely), np.flatnonzero(labels != lonely)
    distance, index = cKDTree(points[rest]).query(points[own])
    k = int(distance.argmin())
    other = int(labels[rest[index[k]]])
    middle = (points[own[k]] + points[rest[index[k]]]) / 2
    return PartJoint((min(lonely, other), max(lonely, other)), middle)
