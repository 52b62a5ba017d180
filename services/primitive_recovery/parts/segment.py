"""Points of an object in, the part of every point out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.parts.borders import PartJoint, joints_of
from services.primitive_recovery.parts.branches import branches
from services.primitive_recovery.parts.coverage import coverage
from services.primitive_recovery.parts.openings import count_holes
from services.primitive_recovery.parts.profile import profile
from services.primitive_recovery.parts.scorer import MODELS, Scorer
from services.primitive_recovery.parts.slice_features import CUTS, slice_features
from services.primitive_recovery.parts.view import PartView, part_view
from shared.schemas.scene import SupportPlane

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

LEAST_QUALITY = 0.35
"""What must speak for a cut through an object."""

LEAST_QUALITY_OF_PIECE = 0.75
"""And through a part that was cut from it: a part cut in vain spoils what was right."""

LEAST_POINTS_OF_PART = 11
"""As many as a superquadric has unknowns."""

COVERAGE_WEIGHT = 2.0
"""What it is worth, in usefulness, that the two sides cover less background than the whole,
as a share of the object. It places a cut that the scorer finds good anywhere nearby, as on a
bottle's shoulder."""

BRANCH_MARGIN = 0.1
"""How much better a branch must be than a cut across an axis."""
SAME_CUT, SAME_MARGIN = 0.5, 0.5
"""And where both cut off much the same (IoU), nothing enclosed between branch and body: there
the border across the axis is the better placed one."""

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
    """

    labels: NDArray[np.int16]
    holes: tuple[int, ...]
    joints: tuple[PartJoint, ...]
    quality: tuple[float, ...]


@dataclass(frozen=True)
class Cutter:
    """Finds where to cut an object in two.

    Attributes
    ----------
    slices, branches : Scorer
        Of cuts across an axis, and of what sticks out of a body.
    """

    slices: Scorer
    branches: Scorer

    @classmethod
    def load(cls) -> Cutter:
        """Return the trained one."""
        return cls(
            Scorer.load(MODELS / "parts_slices.npz"), Scorer.load(MODELS / "parts_branches.npz")
        )

    def best_cut(self, view: PartView) -> tuple[Mask, float]:
        """Return the points (N,) on one side of the best cut, and what speaks for it.

        Across an axis the scorer says whether there is a border, and together
        with the background that the two sides no longer cover, where it is.
        """
        side, best, worth = np.zeros(len(view.points), dtype=bool), -np.inf, -np.inf
        for axis in view.axes[:2]:
            slices = profile(view.centred, axis, view.ray, view.height, view.spacing)
            quality = self.slices(np.vstack(slice_features(slices, view)))
            quality = quality.reshape(2, -1).mean(axis=0)
            if quality.max() > best:
                lower, upper, whole = coverage(slices.width)
                saved = COVERAGE_WEIGHT * (whole - lower[CUTS] - upper[CUTS])
                k = int((quality + saved).argmax())
                side, best = slices.place >= CUTS[k], float(quality.max())
                worth = best + max(float(saved[k]), 0.0)
        found = branches(view)
        if not found:
            return side, worth
        quality = self.branches(np.array([each.features for each in found]))
        k = int(quality.argmax())
        branch = np.asarray(view.picture.at_points(found[k].cells), dtype=bool)
        same = _agreement(side, branch) > SAME_CUT and not found[k].encloses
        if quality[k] > best + (SAME_MARGIN if same else BRANCH_MARGIN):
            return branch, float(quality[k])
        return side, worth


def _agreement(one: Mask, other: Mask) -> float:
    """Return the IoU of the smaller sides of two cuts."""
    small = [side if 2 * side.sum() < len(side) else ~side for side in (one, other)]
    return float((small[0] & small[1]).sum() / max((small[0] | small[1]).sum(), 1))


def segment(
    points: Array, viewpoint: Array, plane: SupportPlane | None, cutter: Cutter
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
    """
    view = part_view(points, viewpoint, plane)
    labels = np.zeros(len(points), dtype=np.int16)
    quality: list[float] = []
    waiting = [(np.arange(len(points)), view)]
    while waiting and len(quality) + 1 < MOST_PARTS:
        rows, piece = waiting.pop(0)
        if len(rows) < LEAST_POINTS:
            continue
        side, best = cutter.best_cut(piece)
        least = LEAST_QUALITY_OF_PIECE if piece.is_piece else LEAST_QUALITY
        smaller = min(int(side.sum()), int((~side).sum()))
        if best < least or smaller < LEAST_POINTS_OF_PART:
            continue
        quality.append(best)
        labels[rows[side]] = len(quality)
        waiting += [
            (kept, part_view(points[kept], viewpoint, plane, is_piece=True))
            for kept in (rows[~side], rows[side])
            if len(kept) >= LEAST_POINTS
        ]
    labels = _largest_first(labels)
    return Segmentation(
        labels=labels,
        holes=count_holes(view.picture, labels),
        joints=joints_of(points, view.picture, labels),
        quality=tuple(quality),
    )


def _largest_first(labels: NDArray[np.int16]) -> NDArray[np.int16]:
    order = np.argsort(-np.bincount(labels), kind="stable")
    rank = np.empty(len(order), dtype=np.int16)
    rank[order] = np.arange(len(order), dtype=np.int16)
    return rank[labels]
