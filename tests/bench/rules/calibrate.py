"""`python -m tests.bench.rules.calibrate`: what a region's certainty is worth, and a map for it.

Fits P(the region is good) = 1 / (1 + exp(-(a + b logit c))) to certainties c (Platt
scaling): strictly rising, so that no ranking changes.
"""

from __future__ import annotations

import argparse
import tempfile
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from services.reasoning.confidence import Map, logit
from services.reasoning.reasoner import Reasoner
from services.reasoning.settings import ReasoningSettings
from tests.bench.rules.__main__ import made, say
from tests.bench.rules.judge import judge

Array = NDArray[np.float64]
BINS = 10
EDGES = (0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 1.01)


def main(arguments: list[str] | None = None) -> None:
    """Fit on the objects of even number, report on the others."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench.rules.calibrate")
    parser.add_argument("--seed", type=int, default=100, help="not one that experiments use")
    parser.add_argument("--per-class", type=int, default=20)
    parser.add_argument("--cache", type=Path)
    given = parser.parse_args(arguments)
    parts = [
        each
        for kind in ("variants", "odd")
        for noisy in (False, True)
        for each in made(given.seed, given.per_class, kind, noisy=noisy, cache=given.cache)
        if each.cut == "recovered"
    ]
    with tempfile.TemporaryDirectory() as folder:
        reasoner = Reasoner(ReasoningSettings(knowledge_dir=Path(folder), confidence_file=None))
        reasoner.warm_up()
        found = [each for each in judge(reasoner, parts, "v2") if each.found and each.afforded]
        reasoner.close()
    even = np.array([int(each.parts.name.rsplit("-", 1)[1]) % 2 == 0 for each in found])
    certainty = np.array([each.confidence for each in found])
    good = np.array([float(each.right) for each in found])
    scale = Map(*(round(each, 3) for each in fitted(certainty[even], good[even])))
    say(f"map: offset {scale.offset}, slope {scale.slope}; from {even.sum()} answers")
    certainty, good = certainty[~even], good[~even]
    mapped = np.array([scale(each) for each in certainty])
    say(f"held out: {len(good)} answers, {100 * good.mean():.1f} % of them good")
    say(f"expected calibration error: certainty {error(certainty, good):.3f}")
    say(f"                            confidence {error(mapped, good):.3f}")
    say("confidence    answers   mean   good")
    for low, high in pairwise(EDGES):
        own = (mapped >= low) & (mapped < high)
        if own.any():
            say(
                f"{low:.2f} to {high:.2f} {own.sum():9d} {mapped[own].mean():7.3f} "
                f"{good[own].mean():6.3f}"
            )


def fitted(certainty: Array, good: Array) -> tuple[float, float]:
    """Return offset and slope of the most likely map; a weak prior keeps it from steps."""
    x = np.array([logit(each) for each in certainty])

    def cost(parameters: Array) -> float:
        z = parameters[0] + parameters[1] * x
        likelihood = np.logaddexp(0, z) - good * z
        return float(likelihood.sum() + 0.5 * (parameters[1] - 1) ** 2)

    a, b = minimize(cost, np.array([0.0, 1.0])).x
    return float(a), max(float(b), 0.05)


def error(confidence: Array, good: Array) -> float:
    """Return the expected calibration error over `BINS` bins of equal width."""
    bin_of = np.minimum((confidence * BINS).astype(int), BINS - 1)
    return float(
        sum(
            (bin_of == k).mean() * abs(confidence[bin_of == k].mean() - good[bin_of == k].mean())
            for k in np.unique(bin_of)
        )
    )


if __name__ == "__main__":
    main()
