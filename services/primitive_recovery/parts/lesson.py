"""A labelled view as the cutter meets it: points, support plane, true part of every point."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from shared.schemas.scene import SupportPlane

Array = NDArray[np.float64]

DEPTH_UNIT = 1e-4
FIRST_REGION = 2
LEAST_VISIBLE = 0.015
"""Share of the points that a region must have for a cut to be worth finding."""


@dataclass(frozen=True)
class Lesson:
    """An object, or a piece of one.

    Attributes
    ----------
    points : (N, 3) array
        In the camera's frame, metres.
    region : (N,) int array
        True part of every point, from 0; -1 for parts too small to matter.
    plane : SupportPlane or None
        What it lies on, seen as well as a sensor does.
    is_piece : bool
        Whether it was cut from a larger object.
    """

    points: Array
    region: NDArray[np.intp]
    plane: SupportPlane | None
    is_piece: bool = False


def read_lesson(path: Path, rng: np.random.Generator) -> Lesson:
    """Return the object in a view (docs/dataset.md), as perception might have found it.

    At random the support plane is unknown, or a bit off, and points close to
    it are lost; the points are fewer and in no lattice; or there are as many on
    the far side, as in a cloud merged from views all around.
    """
    with np.load(path, allow_pickle=False) as held:
        depth, label, matrix = held["depth"], held["label"], held["K"]
        pose, table, tasks = held["T_cam_world"], float(held["table_height"]), len(held["tasks"])
        packed = held["regions"]
    row, column = np.nonzero(label >= FIRST_REGION)
    z = depth[row, column] * DEPTH_UNIT
    x = (column - matrix[0, 2]) / matrix[0, 0] * z
    y = (row - matrix[1, 2]) / matrix[1, 1] * z
    points = np.column_stack([x, y, z])
    masks = np.unpackbits(packed, axis=-1, count=depth.shape[1]).astype(bool)[:, row, column]
    region = np.where(masks.any(axis=0), masks.argmax(axis=0), tasks)
    normal = pose[:3, 2]
    offset = -float(normal @ (pose[:3, 3] + table * normal))
    offset += float(rng.normal(0, 0.0007))
    height = points @ normal + offset
    if rng.random() < 0.6:
        kept = height > rng.uniform(0.0, 0.004)
        points, region = points[kept], region[kept]
    if rng.random() < 0.2:
        kept = rng.random(len(points)) < rng.uniform(0.25, 0.8)
        points, region = points[kept], region[kept]
    if rng.random() < 0.08:
        middle = points.mean(axis=0)
        ray = middle / np.linalg.norm(middle)
        behind = points - 2 * np.outer((points - middle) @ ray - rng.uniform(0, 0.02), ray)
        points, region = np.vstack([points, behind]), np.concatenate([region, region])
    plane = SupportPlane(
        normal=(float(normal[0]), float(normal[1]), float(normal[2])),
        offset=offset,
        inliers=1,
        residual_mm=1.0,
    )
    return Lesson(points, _numbered(region), plane if rng.random() < 0.85 else None)


def pieces(lesson: Lesson) -> list[Lesson]:
    """Return the parts of an object, and all of it but one part, as objects of their own."""
    parts = range(int(lesson.region.max(initial=-1)) + 1)
    found = []
    for part in parts:
        own = lesson.region == part
        found.append(own)
        if len(parts) > 2:
            found.append(~own)
    return [
        Lesson(lesson.points[kept], _numbered(lesson.region[kept]), lesson.plane, True)
        for kept in found
        if len(parts) > 1
    ]


def _numbered(region: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return regions counted from 0 without gaps, -1 for those that hardly show."""
    fresh = np.full(len(region), -1, dtype=np.intp)
    for part in np.unique(region[region >= 0]):
        own = region == part
        if own.sum() >= LEAST_VISIBLE * len(region):
            fresh[own] = fresh.max(initial=-1) + 1
    return fresh


def quality(inside: Array, total: Array, cut: float, whole: float) -> float:
    """Return how well a cut parts the regions: the lower of the two sides' IoU.

    Each region counts to the side that holds most of it; with all of them on
    one side there is nothing to part, and the quality is zero.

    Parameters
    ----------
    inside, total : (R,) array
        Points of every region on one side of the cut, and at all.
    cut, whole : float
        Points on that side, and at all.
    """
    here = 2 * inside > total
    if here.all() or not here.any():
        return 0.0
    right = float(inside[here].sum())
    one = right / (cut + float(total[here].sum()) - right)
    outside = total - inside
    right = float(outside[~here].sum())
    other = right / (whole - cut + float(total[~here].sum()) - right)
    return min(one, other)
