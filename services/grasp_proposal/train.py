"""`python -m services.grasp_proposal.train TRIALS`: train the network that scores grasps anew.

TRIALS is what `python -m experiments.trials` writes. Needs the training extra.
"""

from __future__ import annotations

import argparse
import hashlib
import logging
import time
from pathlib import Path

from services.grasp_proposal.learned import MODEL
from services.grasp_proposal.training.card import card
from services.grasp_proposal.training.evaluation import calibrated, ensemble, held_out, report
from services.grasp_proposal.training.export import to_onnx
from services.grasp_proposal.training.lessons import read_lessons

logger = logging.getLogger(__name__)


def train(trials: Path, out: Path, *, folds: int, epochs: int, networks: int, seed: int) -> None:
    """Write the model and its card.

    Parameters
    ----------
    trials : Path
        Folder of tried grasps.
    out : Path
        The ONNX file; the card gets its name with `.md`.
    folds : int
        Parts that the objects are cut into for the figures and the calibration.
    epochs, networks, seed : int
        Passes over the grasps; how many networks the shipped answer is the mean of.
    """
    started = time.perf_counter()
    lessons = read_lessons(trials)
    logger.info("%d grasps read, %.0f s", len(lessons), time.perf_counter() - started)
    found = held_out(lessons, folds, epochs, networks, seed)
    figures = report(lessons, found)
    logger.info("judged on held-out objects, %.0f s", time.perf_counter() - started)
    shipped = ensemble(lessons, epochs, networks, seed)
    platt = calibrated(lessons, found.logits)
    content = to_onnx(shipped, platt).SerializeToString(deterministic=True)
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_bytes(content)
    command = (
        f"python -m services.grasp_proposal.train TRIALS --folds {folds} --epochs {epochs} "
        f"--networks {networks} --seed {seed}"
    )
    text = card(lessons, figures, command, hashlib.sha256(content).hexdigest())
    out.with_suffix(".md").write_text(text, encoding="utf-8")
    logger.info("done, %.0f s\n\n%s", time.perf_counter() - started, text)


def main(arguments: list[str] | None = None) -> None:
    """Parse the command line and train."""
    parser = argparse.ArgumentParser(prog="python -m services.grasp_proposal.train")
    parser.add_argument("trials", type=Path)
    parser.add_argument("--out", type=Path, default=MODEL)
    parser.add_argument("--folds", type=int, default=5)
    parser.add_argument("--epochs", type=int, default=15)
    parser.add_argument("--networks", type=int, default=4)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args(arguments)
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    train(
        given.trials,
        given.out,
        folds=given.folds,
        epochs=given.epochs,
        networks=given.networks,
        seed=given.seed,
    )


if __name__ == "__main__":
    main()
