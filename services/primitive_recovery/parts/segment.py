"""Points of an object in, the part of every point out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.parts.borders import PartJoint, joints_of
from services.primitive_recovery.parts.convexity import is_convex
from services.primitive_recovery.parts.cutter import Cutter
from services.primitive_recovery.parts.openings import count_holes
from services.primitive_recovery.parts.view import PartView, part_view
from shared.schemas.scene import SupportPlane

Array = NDArray[np.float64]

LEAST_QUALITY = 0.35
"""What must speak for a cut through an object."""

LEAST_QUALITY_OF_PIECE = 0.75
"""And through a part that was cut from it: a part cut in vain spoils what was right."""

LEAST_POINTS_OF_PART = 11
"""As many as a superquadric has unknowns."""

MOST_PARTS = 6

LEAST_POINTS = 60
"""Fewer show no shape to cut."""


@dataclass(frozen=True)
class Segmentation:
    """The parts of an object, largest first.

    Attributes
    ----------
    labels : (N,) int16 array
        Part of every point.
    holes : tuple of int
        Openings through each part that background was seen through.
    joints : tuple of PartJoint
        Which parts meet, and where.
    quality : tuple of float
        What spoke for each cut, in the order they were made.
    front : (U, 3) array
        Points of what hides the object, as dense as its own, metres.
    """

    labels: NDArray[np.int16]
    holes: tuple[int, ...]
    joints: tuple[PartJoint, ...]
    quality: tuple[float, ...]
    front: Array


def segment(
    points: Array,
    viewpoint: Array,
    plane: SupportPlane | None,
    cutter: Cutter,
    others: Array | None = None,
) -> Segmentation:
    """Return the parts of an object.

    Parameters
    ----------
    points : (N, 3) array
        The object's visible points in metres, in any order.
    viewpoint : (3,) array
        Where the sensor was.
    plane : SupportPlane, optional
        What the object stands on.
    cutter : Cutter
        The trained scorers.
    others : (M, 3) array, optional
        Points of other things, metres. Where they are in front of the object it is cut as
        if it went on straight behind them; the border of what they hide is no edge of it.
    """
    view = part_view(points, viewpoint, plane, others=others)
    seen = len(points)
    behind = view.bridges()
    if len(behind):
        points = np.vstack([points, behind])
        view = part_view(points, viewpoint, plane, others=others)
    labels = np.zeros(len(points), dtype=np.int16)
    quality: list[float] = []
    whole = view.amid and is_convex(view.centred, view.spacing)
    waiting = [] if whole else [(np.arange(len(points)), view)]
    while waiting and len(quality) + 1 < MOST_PARTS:
        rows, piece = waiting.pop(0)
        if len(rows) < LEAST_POINTS:
            continue
        side, best = cutter.best_cut(piece)
        least = LEAST_QUALITY_OF_PIECE if piece.is_piece else LEAST_QUALITY
        visible = side[rows < seen]
        smaller = min(int(visible.sum()), int((~visible).sum()))
        if best < least or smaller < LEAST_POINTS_OF_PART:
            continue
        if not piece.is_piece and _may_be_whole(piece, plane, others, cutter):
            continue
        quality.append(best)
        labels[rows[side]] = len(quality)
        waiting += [
            (kept, part_view(points[kept], viewpoint, plane, others=others, is_piece=True))
            for kept in (rows[~side], rows[side])
            if len(kept) >= LEAST_POINTS
        ]
    labels = _largest_first(labels, seen)
    return Segmentation(
        labels=labels[:seen],
        holes=count_holes(view.picture, labels, view.hidden.mask, seen),
        joints=joints_of(points, view.picture, labels),
        quality=tuple(quality),
        front=view.middle + view.hidden.front,
    )


def _may_be_whole(
    view: PartView, plane: SupportPlane | None, others: Array | None, cutter: Cutter
) -> bool:
    """Whether nothing would speak for a cut, were the object simple where it is hidden.

    A corner that something hides looks like the inner corner between two parts.
    """
    for filling in view.fillings():
        points = np.vstack([view.points, filling])
        simple = part_view(points, view.viewpoint, plane, others=others)
        if cutter.best_cut(simple)[1] < LEAST_QUALITY:
            return True
    return False


def _largest_first(labels: NDArray[np.int16], seen: int) -> NDArray[np.int16]:
    """Return the labels (N,) by the size of the parts among the first `seen`."""
    order = np.argsort(-np.bincount(labels[:seen]), kind="stable")
    rank = np.empty(len(order), dtype=np.int16)
    rank[order] = np.arange(len(order), dtype=np.int16)
    return rank[labels]
