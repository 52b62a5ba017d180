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
    if count == 1:
        return ()
    height, width = picture.mask.shape
    part = np.full((height, width), -1, dtype=np.intp)
    part[picture.row, picture.column] = labels
    cell = np.arange(height * width).reshape(height, width)
    here = np.concatenate([cell[:-1].ravel(), cell[:, :-1].ravel()])
    there = np.concatenate([cell[1:].ravel(), cell[:, 1:].ravel()])
    one, other = part.ravel()[here], part.ravel()[there]
    meet = (one >= 0) & (other >= 0) & (one != other)
    here, there = here[meet], there[meet]
    low, high = np.minimum(one, other)[meet], np.maximum(one, other)[meet]
    of_point = picture.row * width + picture.column
    found: list[PartJoint] = []
    for key in np.unique(low * count + high):
        own = low * count + high == key
        border = np.union1d(here[own], there[own])
        if len(border) >= _FEWEST:
            on_border = np.zeros(height * width, dtype=bool)
            on_border[border] = True
            middle = points[on_border[of_point]].mean(axis=0)
            found.append(PartJoint((int(key // count), int(key % count)), middle))
    for part_alone in range(count):
        if not any(part_alone in joint.parts for joint in found):
            found.append(_closest(points, labels, part_alone))
    return tuple(found)


def _closest(points: Array, labels: NDArray[np.int16], alone: int) -> PartJoint:
    own, rest = np.flatnonzero(labels == alone), np.flatnonzero(labels != alone)
    found = cKDTree(points[rest]).query(points[own])
    distance, nearest = np.asarray(found[0]), np.asarray(found[1], dtype=np.intp)
    k = int(distance.argmin())
    partner = int(labels[rest[nearest[k]]])
    middle = (points[own[k]] + points[rest[nearest[k]]]) / 2
    return PartJoint((min(alone, partner), max(alone, partner)), middle)
