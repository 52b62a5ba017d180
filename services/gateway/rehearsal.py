"""Grasps in doubt are rehearsed: tried in simulation, on what was recovered, then answered.

What the proposer's network has not seen, a heavy thing that turns between the pads, a simulation
of the shape that the answer believes in can tell (docs/decisions/0032-rehearsal.md).
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from shared.errors import SpargeError
from shared.schemas.execution import BELIEVED, ExecuteResponse, Outcome
from shared.schemas.grasp import ProposeResponse, SelectResponse
from shared.schemas.rehearsal import Rehearsal, Rehearsing

Array = NDArray[np.float64]
Select = Callable[[Array, int], Awaitable[SelectResponse]]
Try = Callable[[Array], Awaitable[Sequence[ExecuteResponse]]]

AT_MOST = 2
"""Grasps that are rehearsed for one answer."""
HELD: tuple[Outcome, ...] = tuple("held" for _ in BELIEVED)
_SCORE = 8
_EVIDENCE: MappingProxyType[Outcome, float] = MappingProxyType(
    {"held": 1.24, "slipped_in_shake": 0.41}
)
_LOST = -0.95
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

    What comes of a grasp is evidence that raises or lowers its score. Always the one is tried next
    that would be the best if all that are untried were held; when that one has been tried, it is
    the best, whatever would come of the others.

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
    grasps = proposed.grasps
    known = Rehearsed(await select(grasps, 0))
    answered = known.selected.indices
    if rehearsing == "never" or not len(answered):
        return known
    if rehearsing == "auto" and not proposed.doubtful[answered[0]]:
        return known
    rows = (await select(grasps, AT_MOST)).indices
    if rehearsing == "auto":
        rows = rows[proposed.doubtful[rows]]
    tried: dict[int, tuple[Outcome, ...]] = dict.fromkeys(rows[:AT_MOST].tolist(), HELD)
    while True:
        best = int((await select(rescored(grasps, tried), 0)).indices[0])
        if best in known.outcomes or best not in tried:
            break
        try:
            came = tuple(each.outcome for each in await attempt(grasps[best]))
        except SpargeError as error:
            if rehearsing == "always":
                raise
            known.stopped = error.code
            break
        tried[best] = known.outcomes[best] = came
    known.selected = await select(rescored(grasps, known.outcomes), 0)
    return known


def rescored(grasps: Array, outcomes: Mapping[int, Sequence[Outcome]]) -> Array:
    """Return grasp rows (G, 9) with the scores that they have in the light of rehearsals."""
    known = grasps.copy()
    for row, came in outcomes.items():
        known[row, _SCORE] = after(known[row, _SCORE], came)
    return known


def after(score: float, outcomes: Sequence[Outcome]) -> float:
    """Return the score of a grasp, 0 to 1, of which is known what came of its rehearsals."""
    odds = np.exp(sum(_EVIDENCE.get(outcome, _LOST) for outcome in outcomes))
    return float(odds * score / (odds * score + (1 - score)))
