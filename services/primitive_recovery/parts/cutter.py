"""Where to cut an object in two."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.parts.branches import branches
from services.primitive_recovery.parts.coverage import coverage
from services.primitive_recovery.parts.profile import profile
from services.primitive_recovery.parts.scorer import MODELS, Scorer
from services.primitive_recovery.parts.slice_features import CUTS, slice_features
from services.primitive_recovery.parts.view import PartView

Mask = NDArray[np.bool_]

COVERAGE_WEIGHT = 2.0
"""What it is worth, in usefulness, that the two sides cover less background than the whole,
as a share of the object. It places a cut that the scorer finds good anywhere nearby, as on a
bottle's shoulder."""

BRANCH_MARGIN = 0.1
"""How much better a branch must be than a cut across an axis."""
SAME_CUT, SAME_MARGIN = 0.5, 0.5
"""And where both cut off much the same (IoU), nothing enclosed between branch and body: there
the border across the axis is the better placed one."""


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
            slices = profile(
                view.centred, axis, view.ray, view.height, view.spacing, view.hidden.behind
            )
            lower, upper, whole = covered = coverage(slices.width)
            features = slice_features(slices, view, covered)
            quality = self.slices(features.reshape(-1, features.shape[-1]))
            quality = quality.reshape(2, -1).mean(axis=0)
            if quality.max() > best:
                saved = COVERAGE_WEIGHT * (whole - lower[CUTS] - upper[CUTS])
                k = int((quality + saved).argmax())
                side, best = slices.place >= CUTS[k], float(quality.max())
                # A part on its own may well be bent, as handles are.
                worth = best if view.is_piece else best + max(float(saved[k]), 0.0)
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
