"""Grasps in doubt are rehearsed: tried in simulation, on what was recovered, then answered.

What the proposer's network has not seen, a heavy thing that turns between the pads, a simulation
of the shape that the answer believes in can tell (docs/decisions/0032-rehearsal.md).
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from shared.errors import SpargeError
from shared.schemas.execution import ExecuteResponse, Outcome
from shared.schemas.grasp import ProposeResponse, SelectResponse
from shared.schemas.rehearsal import Rehearsal, Rehearsing

Select = Callable[[NDArray[np.float64], int], Awaitable[SelectResponse]]
Try = Callable[[NDArray[np.float64]], Awaitable[Sequence[ExecuteResponse]]]

AT_MOST = 5
"""Grasps that are rehearsed for one answer."""
_SCORE = 8
_EVIDENCE: MappingProxyType[Outcome, float] = MappingProxyType(
    {"held": 0.70, "slipped_in_shake": 0.0}
)
_LOST = -0.57
"""What each outcome, the last all others, adds to the logit of lifting: as
`python -m services.grasp_proposal.training.rehearsal` printed it."""


@dataclass
class Rehearsed:
    """What came of rehearsing the grasps of a proposal.

    Attributes
    ----------
    selected : SelectResponse
        The grasps that hold the region, best first by what is known now.
    outcomes : dict
        On each shape, by row of the proposal.
    stopped : str or None
        Code of the error that ended it too early.
    """

    selected: SelectResponse
    outcomes: dict[int, tuple[Outcome, ...]] = field(default_factory=dict)
    stopped: str | None = None

    @property
    def of_answered(self) -> tuple[tuple[Outcome, ...], ...]:
        """What came of each grasp of the answer; empty where it was not rehearsed."""
        return tuple(self.outcomes.get(int(row), ()) for row in self.selected.indices)

    @property
    def report(self) -> Rehearsal | None:
        """What the answer says of it; None where nothing was in doubt."""
        if not self.outcomes and self.stopped is None:
            return None
        return Rehearsal(tried=len(self.outcomes), stopped=self.stopped)


async def rehearse(
    proposed: ProposeResponse, select: Select, attempt: Try, rehearsing: Rehearsing
) -> Rehearsed:
    """Where the best grasp is in doubt, try it and the next that are; answer the best by then.

    What comes of a grasp is evidence that raises or lowers its score. One that is held on every
    shape ends the search: there is hardly a better one.

    Parameters
    ----------
    proposed : ProposeResponse
    select : callable
        Orders grasp rows (G, 9) and keeps those that hold the region: as many as are to be
        answered, or at least so many.
    attempt : callable
        Simulates one on every shape that the object may have.
    rehearsing : str

    Raises
    ------
    SpargeError
        From `select`; from `attempt` only where rehearsing is `always`.
    """
    if rehearsing == "never":
        return Rehearsed(await select(proposed.grasps, 0))
    known = Rehearsed(await select(proposed.grasps, AT_MOST))
    rows = known.selected.indices
    if rehearsing == "auto":
        doubtful = proposed.doubtful[rows]
        rows = rows[doubtful & doubtful[:1]]  # none, unless the best one is
    grasps = proposed.grasps.copy()
    for row in rows[:AT_MOST].tolist():
        try:
            came = tuple(each.outcome for each in await attempt(grasps[row]))
        except SpargeError as error:
            if rehearsing == "always":
                raise
            known.stopped = error.code
            break
        known.outcomes[row] = came
        grasps[row, _SCORE] = after(grasps[row, _SCORE], came)
        if set(came) == {"held"}:
            break
    known.selected = await select(grasps, 0)
    return known


def after(score: float, outcomes: Sequence[Outcome]) -> float:
    """Return the score of a grasp, 0 to 1, of which is known what came of its rehearsals."""
    odds = np.exp(sum(_EVIDENCE.get(outcome, _LOST) for outcome in outcomes))
    return float(odds * score / (odds * score + (1 - score)))
