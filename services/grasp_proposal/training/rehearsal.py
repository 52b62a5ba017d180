"""`python -m services.grasp_proposal.training.rehearsal TRIALS`: what a rehearsal tells.

TRIALS is what `python -m experiments.trials --rehearse` writes, best of objects that the shipped
network never saw: `--first` beyond the rounds that it was trained on. Scores are by that network.
"""

from __future__ import annotations

import argparse
import logging
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import Bounds, brentq

from services.grasp_proposal.learned import LearnedScorer, sigmoid
from services.grasp_proposal.training.lessons import Lessons, read_lessons
from services.grasp_proposal.training.ranking import fit_pairs, pairs
from shared.errors import InvalidInput

Array = NDArray[np.float64]

logger = logging.getLogger(__name__)

OUTCOMES = ("held", "slipped_in_shake", "lost")
"""All others count as the last."""
_TINY = 1e-9


def fit_evidence(logits: Array, counts: Array, lessons: Lessons) -> Array:
    """Return what each outcome adds to the logit of lifting (3,), by `OUTCOMES`.

    How far the outcomes are apart is what best orders the grasps of one question, for lifting
    and for keeping, whose mean it is (`fit_pairs`); where they lie makes the probabilities of
    lifting true on the whole.

    Parameters
    ----------
    logits : (G,) array
        Of lifting, before the rehearsals.
    counts : (G, 3) array
        How often each outcome came.
    lessons : Lessons
        What really came of the G grasps.
    """
    known = np.column_stack([logits, counts[:, :2]])
    bounds = Bounds([_TINY, -np.inf, -np.inf], [np.inf, np.inf, np.inf])
    steps = []
    for truth in (lessons.lifted, lessons.held):
        weights = fit_pairs(known, truth, lessons.view, bounds)
        steps.append(weights[1:] / weights[0])
    step = np.append(np.mean(steps, axis=0), 0.0)
    often = float(lessons.lifted.mean())
    times = counts.sum(axis=1)
    centre = brentq(lambda at: sigmoid(logits + counts @ step + times * at).mean() - often, -10, 10)
    return np.asarray(step + centre)


def right_order(order: Array, truth: NDArray[np.bool_], view: NDArray[np.intp]) -> float:
    """Return the share of pairs of one question that an order (G,) has the right way round."""
    good, bad, share = pairs(truth, view)
    better = (order[good] > order[bad]) + 0.5 * (order[good] == order[bad])
    return float(share @ better)


def report(lessons: Lessons) -> str:
    """Return, as Markdown, what rehearsals tell, and how well with what share of pairs.

    Raises
    ------
    InvalidInput
        No grasp in doubt was rehearsed.
    """
    mine = lessons.take((lessons.rehearsed != "").all(axis=1))
    if not len(mine):
        raise InvalidInput("no trial was rehearsed; `python -m experiments.trials --rehearse` does")
    scores = np.clip(mine.score, _TINY, 1 - _TINY)
    logits = np.log(scores / (1 - scores))
    counts = counted(mine.rehearsed)
    evidence = fit_evidence(logits, counts, mine)
    lines = [
        f"{len(mine)} of {len(lessons)} grasps are in doubt and can be rehearsed.",
        "",
        "| held on so many shapes | grasps | lifted | kept |",
        "| --- | --- | --- | --- |",
    ]
    for times in range(mine.rehearsed.shape[1] + 1):
        some = mine.take(counts[:, 0] == times)
        share = [f"{truth.mean():.2f}" if len(some) else "-" for truth in (some.lifted, some.held)]
        lines.append(f"| {times} | {len(some)} | {share[0]} | {share[1]} |")
    told = zip(OUTCOMES, evidence, strict=True)
    lines += ["", "Each adds to the logit: " + ", ".join(f"{n} {at:+.2f}" for n, at in told) + "."]
    first = counted(mine.rehearsed[:, :1])
    orders: Mapping[str, Array] = {
        "score": logits,
        "score and superquadrics": logits + first @ fit_evidence(logits, first, mine),
        "score and all shapes": logits + counts @ evidence,
    }
    lines += ["", "| ordered by | lifting | keeping |", "| --- | --- | --- |"]
    for name, order in orders.items():
        shares = [right_order(order, truth, mine.view) for truth in (mine.lifted, mine.held)]
        lines.append(f"| {name} | {shares[0]:.3f} | {shares[1]:.3f} |")
    return "\n".join(lines)


def counted(rehearsed: NDArray[np.str_]) -> Array:
    """Return how often (G, 3) each of `OUTCOMES` came of rehearsals (G, S)."""
    named = [(rehearsed == name).sum(axis=1) for name in OUTCOMES[:-1]]
    return np.column_stack([*named, rehearsed.shape[1] - sum(named)]).astype(np.float64)


def main(arguments: list[str] | None = None) -> None:
    """Print the report."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("trials", type=Path)
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    lessons = read_lessons(parser.parse_args(arguments).trials)
    scores = LearnedScorer().probabilities(lessons.images, lessons.numbers)
    logger.info(report(replace(lessons, score=scores)))


if __name__ == "__main__":
    main()
