"""`python -m experiments.frames`: draw docs/images/frames.png and print the table of offsets."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure

from experiments.frames.hands import draw_linkage, draw_panda
from experiments.frames.scene import draw_scene
from experiments.frames.table import offsets
from shared.grippers import load_grippers
from shared.schemas.gripper import ParallelGripper

PICTURE = Path(__file__).resolve().parents[2] / "docs" / "images" / "frames.png"


def draw(path: Path, dpi: int = 150) -> None:
    """Write the drawing."""
    grippers = load_grippers()
    panda, robotiq = grippers["panda"], grippers["robotiq_2f85"]
    assert isinstance(panda, ParallelGripper)
    assert isinstance(robotiq, ParallelGripper)
    with mpl.rc_context({"font.family": "DejaVu Sans"}):
        figure = Figure(figsize=(11, 9.6), layout="constrained")
        grid = figure.add_gridspec(2, 2, height_ratios=[0.95, 1])
        scene, hand, linkage = (
            figure.add_subplot(grid[cell]) for cell in ((0, slice(None)), (1, 0), (1, 1))
        )
        draw_scene(scene, panda)
        draw_panda(hand, panda)
        draw_linkage(linkage, robotiq)
        figure.savefig(path, dpi=dpi, facecolor="white")


def main() -> None:
    """Draw and print."""
    parser = argparse.ArgumentParser(prog="python -m experiments.frames", description=__doc__)
    parser.add_argument("--out", type=Path, default=PICTURE)
    given = parser.parse_args()
    draw(given.out)
    sys.stdout.write(f"{offsets()}\n")


if __name__ == "__main__":
    main()
