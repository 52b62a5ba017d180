"""Pictures of the experiment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from experiments.framework.plots import OTHER, THESIS, V1, V2, new_figure, tidy
from experiments.shapes.criterion import CLASSES, names
from experiments.shapes.dataset import EXPONENTS
from experiments.shapes.figures import Calibration
from experiments.shapes.model import probabilities

Labels = NDArray[np.int64]

_SIZES: Mapping[str, tuple[float, float, float]] = {
    "1 : 1 : 1": (0.05, 0.05, 0.05),
    "1 : 1 : 2, upright": (0.05, 0.05, 0.1),
    "4 : 1 : 1, lying": (0.1, 0.025, 0.025),
}


def confusions(matrices: Mapping[str, Labels]) -> Figure:
    """Draw confusion matrices side by side, right classes in rows."""
    columns = 3
    rows = -(-len(matrices) // columns)
    figure = new_figure(3.2 * columns, 3.1 * rows)
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes in grid[len(matrices) :]:
        axes.set_axis_off()
    for axes, (title, matrix) in zip(grid, matrices.items(), strict=False):
        share = matrix / np.maximum(matrix.sum(axis=1, keepdims=True), 1)
        axes.imshow(share, cmap="Blues", vmin=0, vmax=1)
        for (row, column), count in np.ndenumerate(matrix):
            axes.text(
                column,
                row,
                f"{count}\n{100 * share[row, column]:.0f} %",
                ha="center",
                va="center",
                fontsize=9,
                color="white" if share[row, column] > 0.5 else "black",
            )
        axes.set_xticks(range(3), CLASSES)
        axes.set_yticks(range(3), CLASSES, rotation=90, va="center")
        axes.set_xlabel("found")
        axes.set_ylabel("right")
        axes.set_title(title, fontsize=10)
    return figure


def reliability(sets: Mapping[str, Calibration]) -> Figure:
    """Draw how often the model is right against how sure it says it is."""
    figure = new_figure(5.0, 4.5)
    axes = figure.subplots()
    axes.plot([1 / 3, 1], [1 / 3, 1], color=THESIS, lw=1, ls="--", label="as it should be")
    for (name, held), colour in zip(sets.items(), (V1, V2, OTHER), strict=False):
        axes.plot(held.stated, held.right, color=colour, lw=1.5)
        axes.scatter(
            held.stated,
            held.right,
            s=12 + 250 * held.weight,
            color=colour,
            label=f"{name}: ECE {held.error:.3f}",
        )
    axes.set_xlabel("stated probability (area of a dot: share of the samples)")
    axes.set_ylabel("share that is right")
    axes.set_xlim(0.32, 1.02)
    axes.set_ylim(0, 1.04)
    axes.legend(loc="lower right")
    tidy(axes)
    return figure


def borders(count: int) -> Figure:
    """Draw which name goes with which exponents: the criterion above, the shipped model below.

    Parameters
    ----------
    count : int
        Of steps from the least exponent to the largest.
    """
    figure = new_figure(9.0, 6.2)
    grid = figure.subplots(2, len(_SIZES), sharex=True, sharey=True)
    steps = np.linspace(*EXPONENTS, count)
    e1, e2 = (axis.ravel() for axis in np.meshgrid(steps, steps, indexing="ij"))
    colours = ListedColormap([V2, V1, OTHER])
    for column, (title, sizes) in enumerate(_SIZES.items()):
        parameters = np.column_stack([e1, e2, np.tile(sizes, (len(e1), 1))])
        kinds: Sequence[tuple[str, Labels]] = (
            ("criterion", names(parameters)),
            ("model", probabilities(parameters).argmax(axis=1)),
        )
        for row, (kind, found) in enumerate(kinds):
            axes = grid[row, column]
            axes.imshow(
                found.reshape(count, count),
                origin="lower",
                extent=(*EXPONENTS, *EXPONENTS),
                cmap=colours,
                vmin=0,
                vmax=2,
            )
            axes.set_title(f"{kind}, sizes {title}", fontsize=9)
        grid[1, column].set_xlabel("e2 (cross-section)")
    for row in range(2):
        grid[row, 0].set_ylabel("e1 (profile)")
    figure.legend(
        handles=[
            Patch(color=colour, label=name)
            for colour, name in zip((V2, V1, OTHER), CLASSES, strict=True)
        ],
        loc="outside lower center",
        ncols=3,
        frameon=False,
    )
    return figure
