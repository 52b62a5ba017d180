"""Examples of a suction cup's places that are left out."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.cup import Cup
from services.grasp_proposal.examples import left_out_as_alike
from services.grasp_proposal.rejections import HandPoses, Rejections
from services.grasp_proposal.workspace import Workspace
from shared.schemas.rejection import RejectionCode

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Rows = NDArray[np.intp]

_BY_REASON: dict[str, RejectionCode] = {
    "no_seal": "no_seal",
    "collision_obstacle": "obstacle",
    "too_heavy": "too_heavy",
}


@dataclass(frozen=True)
class SuctionExamples:
    """Takes examples, where some are wanted.

    Attributes
    ----------
    rejected : Rejections
    workspace : Workspace
    cup : Cup
    centres, rotations : (S, 3), (S, 3, 3) arrays
        The places that are tried.
    above : float
        As `Cup.hits` has it for the object.
    """

    rejected: Rejections
    workspace: Workspace
    cup: Cup
    centres: Array
    rotations: Array
    above: float

    def failed(self, reason: str, which: Mask, rising: Mask) -> None:
        """Take places (S,) that failed a check; `rising` says which are approached from below."""
        if not self.rejected.wanted:
            return
        if reason == "collision_support":
            self._keep("from_below", which & rising)
            self._keep("support_plane", which & ~rising)
        elif reason == "collision_object":
            there = replace(self.cup, pregrasp=0.0)
            hit = there.hits(self.centres, self.rotations, self.workspace.points, self.above)
            self._keep("cup_collides_object", which & hit)
            self._keep("sweep_collides", which & ~hit)
        else:
            self._keep(_BY_REASON[reason], which)

    def alike(self, order: Rows, kept: Rows, limit: int) -> None:
        """Take places that `distinct` left out."""
        if self.rejected.wanted:
            for code, rows in left_out_as_alike(order, kept, limit):
                self._keep(code, rows)

    def _keep(self, code: RejectionCode, which: Mask | Rows) -> None:
        rows = self.rejected.some(which)
        poses = HandPoses(self.centres[rows], self.rotations[rows], np.zeros(len(rows)))
        self.rejected.keep(code, poses)
