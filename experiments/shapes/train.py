"""Train the shipped model anew: `python -m experiments.shapes.train`.

Writes the network and its card into the primitive recovery service. With
`--human-labels FILE`, a CSV of e1, e2, a1, a2, a3, class that the training never
sees, the card reports on it as well.
"""

from __future__ import annotations

import argparse
import logging
import time
from pathlib import Path

import numpy as np

from experiments.shapes.card import Tried, card
from experiments.shapes.criterion import names, perceived
from experiments.shapes.dataset import random_superquadrics, thesis_superquadrics
from experiments.shapes.heuristic import heuristic_classes
from experiments.shapes.human import human_labels
from experiments.shapes.model import (
    EPOCHS,
    FILE,
    FOLDER,
    SAMPLES,
    export,
    probabilities,
    trained,
    training_set,
)

HELD_OUT = 10_000
SEED = 0

logger = logging.getLogger(__name__)


def main(arguments: list[str] | None = None) -> None:
    """Label, train, export, measure what was exported."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--human-labels", type=Path, help="CSV that the card reports on as well")
    parser.add_argument("--output", type=Path, default=FOLDER)
    parser.add_argument("--samples", type=int, default=SAMPLES)
    parser.add_argument("--epochs", type=int, default=EPOCHS)
    options = parser.parse_args(arguments)
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    human = human_labels(options.human_labels) if options.human_labels else None

    start = time.perf_counter()
    logger.info("naming %d random superquadrics", options.samples)
    parameters, classes = training_set(options.samples, np.random.default_rng(SEED))
    logger.info("training, %.0f s so far", time.perf_counter() - start)
    model = trained(parameters, classes, epochs=options.epochs, seed=SEED)
    path = options.output / FILE
    export(model, path)
    logger.info("done in %.0f s", time.perf_counter() - start)

    rng = np.random.default_rng(SEED + 1)
    tried = []
    for name, draw in (("all kinds", random_superquadrics), ("A.1.2", thesis_superquadrics)):
        held_out = draw(HELD_OUT, rng)
        found = probabilities(held_out, path)
        right = names(held_out)
        tried.append(Tried("network", f"{name}, criterion", right, found.argmax(axis=1)))
        tried.append(Tried("Eq. A.4-A.6", f"{name}, criterion", right, heuristic_classes(held_out)))
        said = names(perceived(held_out, rng))
        tried.append(Tried("network", f"{name}, viewer", said, found.argmax(axis=1), found))
        tried.append(Tried("criterion", f"{name}, viewer", said, right))
    if human is not None:
        rows, said = human
        found = probabilities(rows, path)
        tried.append(Tried("network", "human labels", said, found.argmax(axis=1), found))
        tried.append(Tried("criterion", "human labels", said, names(rows)))
        tried.append(Tried("Eq. A.4-A.6", "human labels", said, heuristic_classes(rows)))
    text = card(tried, np.bincount(classes, minlength=3))
    (options.output / "card.md").write_text(text, encoding="utf-8")
    logger.info("%s", text)


if __name__ == "__main__":
    main()
