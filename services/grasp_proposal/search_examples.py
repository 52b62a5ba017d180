"""Examples of hand poses that the search leaves out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.examples import keep_colliding, keep_placed, keep_unplaced
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.orientations import Hands
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.placing import COLLIDES, GOOD, TOO_WIDE, Found, Reach, place_hands
from services.grasp_proposal.rejections import Rejections
from shared.schemas.rejection import RejectionCode

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Rows = NDArray[np.intp]


class SearchExamples:
    """Takes examples of what one search left out.

    Parameters
    ----------
    rejected : Rejections
    surface : (N, 3) array
    hand : Hand
    points : (S, 3) array
        Where hands were tried.
    reach : Reach
    """

    def __init__(
        self, rejected: Rejections, surface: Array, hand: Hand, points: Array, reach: Reach
    ) -> None:
        self._rejected, self._surface, self._hand = rejected, surface, hand
        self._points, self._reach = points, reach

    def impossible(self, hands: Hands) -> None:
        """Take hands that would come from below; not those that have no direction at all."""
        turned = np.abs(hands.rotations).sum(axis=(2, 3)) > 0
        row, which = np.nonzero(~hands.possible & turned)
        some = self._rejected.some(np.arange(len(row)))
        row, which = row[some], which[some]
        rotation = hands.rotations[row, which]
        self._unplaced("from_below", rotation, self._points[row], np.zeros(len(row)))

    def tried(self, rotation: Array, sample: Rows, tip: Array, tried: Mask, found: Found) -> None:
        """Take hands (H, 3, 3) at `sample` (H,) that found no depth, or another one.

        Parameters
        ----------
        tip, tried : (H, D) arrays
            Depths, and which of them were tried.
        found : Found
        """
        low = self._rejected.some(np.asarray(~tried.any(axis=1)))
        self._unplaced("support_plane", rotation[low], self._points[sample[low]], tip[low, 0])
        row, depth = self._some(found.fate == TOO_WIDE)
        self._unplaced("too_wide", rotation[row], self._points[sample[row]], tip[row, depth])
        row, depth = self._some(found.fate == COLLIDES)
        placed = self._placed(rotation[row], sample[row], tip[row, depth])
        width = placed.right - placed.left
        opening = np.minimum(width + 2 * self._hand.clearance, self._hand.max_opening)
        keep_colliding(self._rejected, self._hand, placed, opening, self._surface)
        good = found.fate == GOOD
        for which in range(2):
            has = np.flatnonzero(found.depth[:, which] >= 0)
            good[has, found.depth[has, which]] = False
        row, depth = self._some(good)
        placed = self._placed(rotation[row], sample[row], tip[row, depth])
        keep_placed(self._rejected, "other_depth_better", self._hand, placed)

    def _some(self, which: Mask) -> tuple[Rows, Rows]:
        """Return rows and columns of some of the places (H, D) that are marked."""
        row, depth = np.nonzero(which)
        some = self._rejected.some(np.arange(len(row)))
        return row[some], depth[some]

    def _unplaced(self, code: RejectionCode, rotation: Array, at: Array, tip: Array) -> None:
        keep_unplaced(self._rejected, code, self._hand, rotation, at, tip)

    def _placed(self, rotation: Array, sample: Rows, tip: Array) -> Placements:
        """Return hands at depths that leave room for the fingers, wherever the palm would be."""
        anywhere = self._reach._replace(depth_behind_tip=np.inf)
        tips = np.ascontiguousarray(tip[:, None])
        found = place_hands(
            self._surface,
            self._points,
            sample,
            rotation,
            tips,
            np.ones(tips.shape, dtype=np.bool_),
            anywhere,
        )
        left, right = (each[:, 0].astype(np.float64) for each in (found.left, found.right))
        bin_size = self._reach.bin_size
        return Placements(
            rotation,
            self._points[sample],
            tip,
            -bin_size * (left + 0.5),
            bin_size * (right + 0.5),
            found.front[:, 0],
        )
