"""A labelled view as the cutter meets it: points, support plane, true part of every point."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from services.primitive_recovery.parts.view import part_view
from shared.schemas.scene import SupportPlane

Array = NDArray[np.float64]

DEPTH_UNIT = 1e-4
FIRST_REGION = 2
LEAST_VISIBLE = 0.015
"""Share of the points that a region must have for a cut to be worth finding."""

COVERED = 0.3
"""Share of the views in which something nearer hides a piece of the object."""
MOST_COVERED = 0.5
"""Share of the object that it hides at most."""
THIN = 0.005
"""Metres between the points of what hides it, as perception reports obstacles."""


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
    others : (M, 3) array or None
        Points of something nearer that hides some of it.
    """

    points: Array
    region: NDArray[np.intp]
    plane: SupportPlane | None
    is_piece: bool = False
    others: Array | None = None


def read_lesson(path: Path, rng: np.random.Generator) -> Lesson:
    """Return the object in a view (docs/dataset.md), as perception might have found it.

    At random the support plane is unknown, or a bit off, and points close to
    it are lost; the points are fewer and in no lattice; or there are as many on
    the far side, as in a cloud merged from views all around; or something nearer hides
    a piece of it (`covered`).
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
    lesson = Lesson(points, _numbered(region), plane if rng.random() < 0.85 else None)
    return covered(lesson, rng) if rng.random() < COVERED else lesson


def covered(lesson: Lesson, rng: np.random.Generator) -> Lesson:
    """Return the lesson with a flat thing in front of the object, seen from the origin.

    A rectangle or an ellipse, turned at random in the image, from before an edge of the
    object, from beyond one, or amid it; the same lesson if that hides nothing or too much.
    """
    flat = lesson.points[:, :2] / lesson.points[:, 2:]
    angle = rng.uniform(0, np.pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    placed = flat @ turn
    low, size = placed.min(axis=0), np.ptp(placed, axis=0)
    ends = np.sort(rng.uniform(0, 1, (2, 2)), axis=0)
    for axis in range(2):
        kind = rng.integers(3)
        if kind < 2:
            ends[kind, axis] = -0.3 if kind == 0 else 1.3
    start, end = low + size * ends
    off = np.abs((placed - (start + end) / 2) / ((end - start) / 2))
    is_round = rng.random() < 0.5
    hidden = np.hypot(*off.T) < 1 if is_round else (off < 1).all(axis=1)
    depth = float(lesson.points[:, 2].min()) - rng.uniform(0.015, 0.1)
    u, v = (np.arange(a, b, THIN / depth) for a, b in zip(start, end, strict=True))
    grid = np.column_stack([each.ravel() for each in np.meshgrid(u, v)])
    if is_round:
        grid = grid[np.hypot(*((2 * grid - start - end) / (end - start)).T) < 1]
    if not 0 < hidden.sum() <= MOST_COVERED * len(hidden) or len(grid) < 2:
        return lesson
    return _bridged(
        lesson.points[~hidden],
        lesson.region[~hidden],
        depth * np.column_stack([grid @ turn.T, np.ones(len(grid))]),
        lesson.plane,
    )


def _bridged(
    points: Array, region: NDArray[np.intp], others: Array, plane: SupportPlane | None
) -> Lesson:
    """Return the lesson with points where the object goes on behind others, as when it is cut."""
    behind = part_view(points, np.zeros(3), plane, others=others).bridges()
    nearest = np.asarray(cKDTree(points).query(behind)[1], dtype=np.intp)
    return Lesson(
        np.vstack([points, behind]),
        _numbered(np.concatenate([region, region[nearest]])),
        plane,
        others=others,
    )


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
        replace(
            lesson,
            points=lesson.points[kept],
            region=_numbered(lesson.region[kept]),
            is_piece=True,
        )
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
