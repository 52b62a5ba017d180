"""`python -m experiments.parts OUT`: write the training views, those that are missing."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path

from experiments.camera import StereoNoise
from experiments.catalogue import CatalogueObject
from experiments.dataset.drop import body_of
from experiments.dataset.make import make_view
from experiments.dataset.randomness import generator
from experiments.dataset.view import LabelledView
from experiments.parts.lessons import lessons, noise_level
from shared.errors import InvalidInput
from shared.output import write_whole
from shared.wire.npz import write_npz


def lesson_view(thing: CatalogueObject, seed: int) -> LabelledView:
    """Return a view of the object on a table, through a sensor of random noise.

    Raises
    ------
    InvalidInput
        The object does not fit into the view, or cannot rest on a table.
    """
    number = int(thing.name.split("-")[1])
    # Objects that differ in their regions alone are shown in one and the same scene.
    name = "-".join(thing.name.split("-")[:2])
    view = make_view(body_of(replace(thing, name=name)), number, seed)
    rng = generator(seed, f"sensor before {name}", number)
    sigma, correlation = noise_level(rng)
    if sigma == 0.0:
        return view
    return view.with_noise(StereoNoise(sigma_at_1m=sigma, correlation_px=correlation), rng)


def write_lessons(folder: Path, seed: int, first: int, last: int) -> tuple[int, int]:
    """Write `folder`/<object>/<round>.npz per object; return how many, and how many left out."""
    written = left_out = 0
    for thing in lessons(seed, first, last):
        path = folder / thing.name / f"{thing.name.split('-')[1]}.npz"
        if path.exists():
            continue
        try:
            view = lesson_view(thing, seed)
        except InvalidInput:  # warped out of what fits or rests
            left_out += 1
            continue
        write_whole(path, write_npz(view.arrays(), compress=True))
        written += 1
    return written, left_out


def main(arguments: list[str] | None = None) -> None:
    """Parse the command line and write the views."""
    parser = argparse.ArgumentParser(prog="python -m experiments.parts", description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--first", type=int, default=0, help="round to begin with")
    parser.add_argument("--rounds", type=int, default=200)
    given = parser.parse_args(arguments)
    written, left_out = write_lessons(
        given.out, given.seed, given.first, given.first + given.rounds
    )
    sys.stdout.write(f"{written} views written to {given.out}, {left_out} objects left out\n")


if __name__ == "__main__":
    main()
