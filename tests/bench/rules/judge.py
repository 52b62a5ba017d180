"""Asking the rules about parts, and counting what is right."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from experiments.framework.scoring import GOOD_IOU, overlap
from services.reasoning.reasoner import Reasoner
from shared.schemas.task import DecideRequest, DecideResponse, Version
from tests.bench.rules.parts import Parts


@dataclass(frozen=True)
class Verdict:
    """One question and what became of it.

    Attributes
    ----------
    parts : Parts
    task : str
    version : str
    afforded : bool
        Whether the object serves the task.
    found : bool
    iou : float
        Of the region with the true one; 0 where nothing was found or should be.
    best : float
        The best that any set of these parts could have reached.
    confidence : float
    answer : DecideResponse
    """

    parts: Parts
    task: str
    version: Version
    afforded: bool
    found: bool
    iou: float
    best: float
    confidence: float
    answer: DecideResponse

    @property
    def right(self) -> bool:
        """A good region, or a refusal where the object does not serve the task."""
        return self.iou >= GOOD_IOU if self.afforded else not self.found

    @property
    def possible(self) -> bool:
        """Whether the cut allows a right answer."""
        return not self.afforded or self.best >= GOOD_IOU


def judge(reasoner: Reasoner, all_parts: Iterable[Parts], version: Version) -> list[Verdict]:
    """Ask about every task that an object serves or clearly does not."""
    found: list[Verdict] = []
    for parts in all_parts:
        asked = [*((task, True) for task in parts.regions)]
        asked += [(task, False) for task in parts.not_afforded]
        found += [
            _ask(reasoner, parts, task, version, afforded=afforded) for task, afforded in asked
        ]
    return found


def _ask(
    reasoner: Reasoner, parts: Parts, task: str, version: Version, *, afforded: bool
) -> Verdict:
    answer = reasoner.decide(
        DecideRequest(
            task=task,
            reasoning=version,
            primitives=parts.primitives,
            joints=parts.joints,
            plane=parts.plane,
            explain=False,
        )
    )
    iou = best = confidence = 0.0
    if afforded:
        truth = parts.regions[task]
        best = _best(parts, task)
        if answer.region is not None:
            iou = overlap(np.isin(parts.owner, answer.region.primitive_ids), truth)
    if answer.region is not None:
        confidence = answer.region.confidence
    return Verdict(parts, task, version, afforded, answer.found, iou, best, confidence, answer)


def _best(parts: Parts, task: str) -> float:
    """Return the overlap of the best set of parts: those that lie most in the region."""
    truth = parts.regions[task]
    shares = [
        (float(truth[own].mean()) if own.any() else 0.0, number)
        for number in range(int(parts.owner.max(initial=-1)) + 1)
        for own in [parts.owner == number]
    ]
    ranked = [number for _, number in sorted(shares, reverse=True)]
    return max(
        (
            overlap(np.isin(parts.owner, ranked[:count]), truth)
            for count in range(1, len(ranked) + 1)
        ),
        default=0.0,
    )


def share(verdicts: Sequence[Verdict]) -> str:
    """Return how many are right, as `95/100 (95.0 %)`."""
    if not verdicts:
        return "-"
    right = sum(each.right for each in verdicts)
    return f"{right}/{len(verdicts)} ({100 * right / len(verdicts):.1f} %)"
