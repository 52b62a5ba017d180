"""Draw the pictures of the documentation: `python -m experiments.pictures --url BACKEND`.

They go to docs/images; `make pictures` starts the backend that they ask.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from experiments.catalogue import CATALOGUE, build
from experiments.pictures.margins import draw_margins
from experiments.pictures.small import save_figure
from experiments.pictures.stages import draw_stages
from experiments.pictures.tiles import save_tiles
from experiments.trials.collecting import wait_until_ready
from shared.client import GraspResult, Sparge, connect
from shared.schemas.route import Nothing
from shared.schemas.task import LIST_TASKS
from shared.wire.npz import read_npz

IMAGES = Path(__file__).parents[2] / "docs" / "images"
SAMPLES = Path(__file__).parents[1] / "samples"
OBJECT, SERVES, DOES_NOT = "ladle", "scooping", "hammering"
LIMIT = 2**26


def stages(sparge: Sparge, folder: Path) -> int:
    """Draw the four steps of an answer."""
    view = read_npz((SAMPLES / f"{OBJECT}.npz").read_bytes(), LIMIT)
    depth = view["depth"].astype(np.float64) * float(view["depth_scale"])
    tasks = {each.name: each for each in sparge.call(LIST_TASKS, Nothing()).tasks}
    drawn = draw_stages(depth, float(view["intrinsics"][0, 0]), _ask(sparge, SERVES), tasks[SERVES])
    return save_figure(drawn, folder / "reasoning-stages.webp")


def margins(sparge: Sparge, folder: Path) -> int:
    """Draw a rule that holds and the nearest miss of one that does not, on the same object."""
    holds, misses = (_ask(sparge, task).answer.explanation for task in (SERVES, DOES_NOT))
    assert holds is not None
    assert misses is not None
    assert misses.nearest_miss is not None
    rule = next(each for each in holds.rules if each.rule.endswith(":scoop"))
    panels = [
        (f"{OBJECT}, {SERVES}: part 0 counts as scoop", rule),
        (f"{OBJECT}, {DOES_NOT}: part 0 does not count as pound", misses.nearest_miss),
    ]
    return save_figure(draw_margins(panels), folder / "reasoning-margins.webp")


def gallery(sparge: Sparge, folder: Path) -> int:
    """Draw every object of the catalogue with its regions, labelled and answered."""
    total = 0
    for name in CATALOGUE:
        size, ious = save_tiles(build(name), sparge, folder / "gallery")
        sys.stdout.write(f"{name}: IoU {', '.join(f'{each:.2f}' for each in ious)}\n")
        total += size
    return total


PICTURES: Mapping[str, Callable[[Sparge, Path], int]] = {
    "stages": stages,
    "margins": margins,
    "gallery": gallery,
}


def main() -> None:
    """Draw what is asked for and say how much it weighs."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--url", default="http://127.0.0.1:8000", help="the backend to ask")
    parser.add_argument("--wait", type=float, default=0.0, help="seconds until it is ready")
    parser.add_argument("--out", type=Path, default=IMAGES, help="where to write")
    parser.add_argument("names", nargs="*", help=f"of {', '.join(PICTURES)}; all without any")
    arguments = parser.parse_args()
    unknown = [each for each in arguments.names if each not in PICTURES]
    if unknown:
        parser.error(f"there is no picture {unknown[0]!r}; there are {', '.join(PICTURES)}")
    wait_until_ready(arguments.url, arguments.wait)
    with connect(arguments.url) as sparge:
        for name in arguments.names or PICTURES:
            size = PICTURES[name](sparge, arguments.out)
            sys.stdout.write(f"{name}: {size / 1000:.0f} kB\n")


def _ask(sparge: Sparge, task: str) -> GraspResult:
    path = SAMPLES / f"{OBJECT}.npz"
    return sparge.grasp_file(path.name, path.read_bytes(), task)


if __name__ == "__main__":
    main()
