"""What is asked: the bundled samples and views of the catalogue, for the tasks they serve."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from experiments.framework.catalogue_views import catalogue_sets
from experiments.framework.views import load
from experiments.samples.views import FOLDER, SAMPLES
from shared.wire.npz import read_npz, write_npz

_LIMIT = 2**28


@dataclass(frozen=True)
class Question:
    """The body of POST /grasp as a robot sends it, compressed npz, and the task."""

    body: bytes
    task: str


def sample_questions() -> Iterator[Question]:
    """Yield the five bundled views, which have noise, with every task of theirs."""
    for name in SAMPLES:
        labels = read_npz((FOLDER / f"{name}.labels.npz").read_bytes(), _LIMIT)
        body = (FOLDER / f"{name}.npz").read_bytes()
        for task in labels["tasks"]:
            yield Question(body, str(task))


def catalogue_questions(folder: Path, views: int, seed: int) -> Iterator[Question]:
    """Yield clean views of every object of the catalogue with every task of theirs.

    Parameters
    ----------
    folder : Path
        Keeps the views; they are rendered where it has none.
    views : int
        Of each object.
    seed : int
    """
    for source in catalogue_sets(folder, views, seed):
        for file in source.files:
            shown = load(file)
            body = write_npz(shown.arrays(), compress=True)
            for task in shown.tasks:
                yield Question(body, task)
