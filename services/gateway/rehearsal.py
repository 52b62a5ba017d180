"""Grasps in doubt are rehearsed: tried in simulation, on what was recovered, then answered.

What the proposer's network has not seen, a heavy thing that turns between the pads, a simulation
of the shape that the answer believes in can tell (docs/decisions/0032-rehearsal.md).
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from shared.errors import SpargeError
from shared.schemas.execution import ExecuteResponse, Outcome
from shared.schemas.grasp import ProposeResponse, SelectResponse
from shared.schemas.rehearsal import Rehearsal, Rehearsing

Select = Callable[[NDArray[np.float64]], Awaitable[SelectResponse]]
Try = Callable[[NDArray[np.float64]], Awaitable[ExecuteResponse]]

AT_MOST = 10
"""Grasps that are rehearsed for one answer."""
_SCORE = 8
_EVIDENCE: MappingProxyType[Outcome, float] = MappingProxyType(
    {"held": 0.81, "slipped_in_shake": -0.18}
)
_LOST = -1.05
"""What outcomes, the last all others, add to the logit of lifting: as
`python -m services.grasp_proposal.training.rehearsal` printed it."""


@dataclass
class Rehearsed:
    """What came of rehearsing the grasps of a proposal.

    Attributes
    ----------
    selected : SelectResponse
        The grasps that hold the region, best first by what is known now.
    outcomes : dict
        By row of the proposal.
    stopped : str or None
        Code of the error that ended it too early.
    """

    selected: SelectResponse
    outcomes: dict[int, Outcome] = field(default_factory=dict)
    stopped: str | None = None

    @property
    def of_answered(self) -> tuple[Outcome | None, ...]:
        """What came of each grasp of the answer; None where it was not rehearsed."""
        return tuple(self.outcomes.get(int(row)) for row in self.selected.indices)

    @property
    def report(self) -> Rehearsal | None:
        """What the answer says of it; None where nothing was in doubt."""
        if not self.outcomes and self.stopped is None:
            return None
        return Rehearsal(tried=len(self.outcomes), stopped=self.stopped)


async def rehearse(
    proposed: ProposeResponse, select: Select, attempt: Try, rehearsing: Rehearsing
) -> Rehearsed:
    """Try the best grasp while it is in doubt; what comes of it is evidence, and others follow.

    Best-first: each outcome raises or lowers a grasp's score, and the search ends when the best
    one is known, or is in no doubt.

    Parameters
    ----------
    proposed : ProposeResponse
    select : callable
        Orders grasp rows (G, 9) and keeps those that hold the region.
    attempt : callable
        Simulates one.
    rehearsing : str

    Raises
    ------
    SpargeError
        From `select`; from `attempt` only where rehearsing is `always`.
    """
    grasps = proposed.grasps.copy()
    known = Rehearsed(await select(grasps))
    while rehearsing != "never" and len(known.selected.indices) and len(known.outcomes) < AT_MOST:
        best = int(known.selected.indices[0])
        if best in known.outcomes:
            break
        if rehearsing == "auto" and not proposed.doubtful[best]:
            break
        try:
            outcome = (await attempt(grasps[best])).outcome
        except SpargeError as error:
            if rehearsing == "always":
                raise
            known.stopped = error.code
            break
        known.outcomes[best] = outcome
        grasps[best, _SCORE] = after(grasps[best, _SCORE], outcome)
        known.selected = await select(grasps)
    return known


def after(score: float, outcome: Outcome) -> float:
    """Return the score of a grasp, 0 to 1, of which is known what came of its rehearsal."""
    odds = np.exp(_EVIDENCE.get(outcome, _LOST))
    return float(odds * score / (odds * score + (1 - score)))
