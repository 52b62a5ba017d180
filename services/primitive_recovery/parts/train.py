"""`python -m services.primitive_recovery.parts.train VIEWS`: train the scorers of cuts anew.

VIEWS is what `python -m experiments.parts` writes. Needs scikit-learn.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from sklearn.exceptions import ConvergenceWarning
from sklearn.neural_network import MLPRegressor

from services.primitive_recovery.parts.branches import branches
from services.primitive_recovery.parts.coverage import coverage
from services.primitive_recovery.parts.lesson import Lesson, pieces, quality, read_lesson
from services.primitive_recovery.parts.profile import SLICES, Profile, profile
from services.primitive_recovery.parts.scorer import MODELS
from services.primitive_recovery.parts.segment import LEAST_POINTS
from services.primitive_recovery.parts.slice_features import CUTS, slice_features
from services.primitive_recovery.parts.view import part_view
from shared.wire.npz import write_npz

Array = NDArray[np.float64]

WORST, BEST = 0.4, 0.85
"""Qualities that count as useless and as perfect; between them usefulness grows evenly."""

OTHERS = 16
"""Cuts of every profile that are shown though they are useless."""

ROUNDS = 40
"""Passes over all cuts at most."""

PIECES = 0.5
"""Share of the pieces that are shown."""


@dataclass
class Rows:
    """Features seen so far, and how useful each cut was."""

    features: list[Array] = field(default_factory=list)
    useful: list[Array] = field(default_factory=list)

    def add(self, features: Array, useful: Array) -> None:
        self.features.append(features.astype(np.float32))
        self.useful.append(useful.astype(np.float32))


def usefulness(found: Array) -> Array:
    """Return how useful cuts of these qualities are, 0 to 1."""
    return np.clip((found - WORST) / (BEST - WORST), 0.0, 1.0)


def show(lesson: Lesson, slices: Rows, sticks: Rows, rng: np.random.Generator) -> None:
    """Add the cuts of an object to the rows."""
    if len(lesson.points) < LEAST_POINTS:
        return
    view = part_view(lesson.points, np.zeros(3), lesson.plane, is_piece=lesson.is_piece)
    total = _counts(lesson, np.ones(len(lesson.points), dtype=bool))
    for axis in view.axes[:2]:
        cut = profile(view.centred, axis, view.ray, view.height, view.spacing)
        useful = usefulness(_slice_quality(lesson, cut, total))
        shown = useful > 0
        useless = np.flatnonzero(~shown)
        shown[rng.choice(useless, min(OTHERS, len(useless)), replace=False)] = True
        features, turned = slice_features(cut, view, coverage(cut.width))
        half = rng.random(len(CUTS)) < 0.5
        slices.add(np.where(half[:, None], features, turned)[shown], useful[shown])
    for branch in branches(view):
        side = np.asarray(view.picture.at_points(branch.cells), dtype=bool)
        found = quality(_counts(lesson, side), total, float(side.sum()), float(len(side)))
        sticks.add(branch.features[None], usefulness(np.array([found])))


def _counts(lesson: Lesson, side: NDArray[np.bool_]) -> Array:
    own = lesson.region[side]
    parts = int(lesson.region.max(initial=-1)) + 1
    return np.bincount(own[own >= 0], minlength=parts).astype(np.float64)


def _slice_quality(lesson: Lesson, cut: Profile, total: Array) -> Array:
    place = np.minimum(cut.place.astype(np.intp), SLICES - 1)
    points = np.cumsum(np.bincount(place, minlength=SLICES))
    below = np.array(
        [
            np.cumsum(np.bincount(place[lesson.region == part], minlength=SLICES))
            for part in range(len(total))
        ]
    ).reshape(len(total), SLICES)
    return np.array(
        [quality(below[:, k - 1], total, float(points[k - 1]), float(points[-1])) for k in CUTS]
    )


def fitted(rows: Rows, layers: tuple[int, ...], decay: float, seeds: range) -> dict[str, Array]:
    """Return the arrays of a scorer's file, fitted to the rows."""
    features, useful = np.concatenate(rows.features), np.concatenate(rows.useful)
    mean, deviation = features.mean(axis=0), features.std(axis=0) + 1e-6
    scaled = np.clip((features - mean) / deviation, -4, 4)
    held: dict[str, Array] = {
        "networks": np.array(len(seeds)),
        "layers": np.array(len(layers) + 1),
        "mean": mean,
        "deviation": deviation,
    }
    for n, seed in enumerate(seeds):
        network = MLPRegressor(
            hidden_layer_sizes=layers,
            alpha=decay,
            batch_size=min(1024, len(useful) // 2),
            learning_rate_init=2e-3,
            max_iter=ROUNDS,
            early_stopping=True,
            validation_fraction=0.05,
            n_iter_no_change=4,
            random_state=seed,
        )
        with warnings.catch_warnings():  # ROUNDS is where it ends, settled or not
            warnings.simplefilter("ignore", ConvergenceWarning)
            network.fit(scaled, useful)
        for k, (weights, bias) in enumerate(zip(network.coefs_, network.intercepts_, strict=True)):
            held[f"weights_{n}_{k}"] = weights.astype(np.float32)
            held[f"bias_{n}_{k}"] = bias.astype(np.float32)
    return held


def train(views: Path, out: Path, seed: int, most: int | None) -> tuple[int, int]:
    """Write both scorers from a folder of views; return how many cuts of each kind were shown."""
    rng = np.random.default_rng(seed)
    slices, sticks = Rows(), Rows()
    paths = sorted(views.glob("*/*.npz"), key=lambda path: (int(path.stem), path.parent.name))
    for path in paths[:most]:
        lesson = read_lesson(path, rng)
        show(lesson, slices, sticks, rng)
        for piece in pieces(lesson):
            if rng.random() < PIECES:
                show(piece, slices, sticks, rng)
    seeds = range(seed, seed + 3)
    (out / "parts_slices.npz").write_bytes(write_npz(fitted(slices, (64, 32), 1e-4, seeds)))
    (out / "parts_branches.npz").write_bytes(write_npz(fitted(sticks, (32, 16), 1e-3, seeds)))
    return sum(map(len, slices.useful)), sum(map(len, sticks.useful))


def main(arguments: list[str] | None = None) -> None:
    """Parse the command line and train."""
    parser = argparse.ArgumentParser(prog="python -m services.primitive_recovery.parts.train")
    parser.add_argument("views", type=Path)
    parser.add_argument("--out", type=Path, default=MODELS)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--most", type=int, help="use this many views at most")
    given = parser.parse_args(arguments)
    shown = train(given.views, given.out, given.seed, given.most)
    sys.stdout.write(f"{shown[0]} cuts across axes and {shown[1]} branches shown\n")


if __name__ == "__main__":
    main()
