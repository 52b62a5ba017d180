"""Plots without a window: matplotlib's objects, no pyplot."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from experiments.framework.cells import Share

V1, V2, THESIS, OTHER, GRID = "#2F6DB5", "#D9792B", "#9A9A9A", "#3A8F5C", "#E6E6E6"
COLOURS: Mapping[str, str] = {"Version 1": V1, "Version 2": V2}


def new_figure(width: float = 8.0, height: float = 4.0) -> Figure:
    """Return an empty figure, inches."""
    figure = Figure(figsize=(width, height), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def png(figure: Figure) -> bytes:
    """Return a figure as PNG; same figure, same bytes."""
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=110, metadata={"Software": None})
    return stream.getvalue()


def tidy(axes: Axes) -> None:
    """Take away what is not needed."""
    axes.grid(axis="y", color=GRID)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def iou_frame(axes: Axes, threshold: float, counted: str) -> None:
    """Finish a plot of the share of `counted` things that reach an IoU, in percent."""
    axes.axvline(threshold, color="black", lw=0.8)
    label = f"% of {counted} with at least this IoU"
    axes.set(xlim=(0, 1), ylim=(0, 100), xlabel="IoU", ylabel=label)
    axes.legend(fontsize=9)
    tidy(axes)


def share_bars(
    axes: Axes,
    groups: Sequence[str],
    bars: Mapping[str, Sequence[Share | None]],
    *,
    colours: Mapping[str, str] | None = None,
    beside: Mapping[str, Sequence[float | None]] | None = None,
) -> None:
    """Draw shares in groups, with their 95 % intervals, and the thesis's beside as diamonds.

    Parameters
    ----------
    axes : Axes
    groups : sequence of str
        Below the groups of bars.
    bars : mapping
        Name of a series -> a share for every group, None where there is none.
    colours : mapping, optional
        Name of a series -> colour.
    beside : mapping, optional
        Name of a series -> the thesis's share for every group.
    """
    colours = colours or COLOURS
    width = 0.8 / max(len(bars), 1)
    for index, (name, shares) in enumerate(bars.items()):
        at = np.arange(len(groups)) + (index - (len(bars) - 1) / 2) * width
        held = [(x, share) for x, share in zip(at, shares, strict=True) if share and share.total]
        x = np.array([each for each, _ in held])
        height = np.array([100 * share.value for _, share in held])
        bounds = np.array([share.interval for _, share in held]).reshape(-1, 2) * 100
        axes.bar(x, height, width * 0.92, color=colours.get(name, OTHER), label=name)
        below, above = np.maximum(height - bounds[:, 0], 0), np.maximum(bounds[:, 1] - height, 0)
        axes.errorbar(x, height, [below, above], fmt="none", ecolor="#333333", capsize=2, lw=0.9)
        if beside and name in beside:
            pairs = [
                (x, 100 * share)
                for x, share in zip(at, beside[name], strict=True)
                if share is not None
            ]
            across, up = np.array(pairs).reshape(-1, 2).T
            axes.scatter(
                across,
                up,
                marker="D",
                s=26,
                color="white",
                edgecolor="black",
                zorder=4,
                label="thesis" if index == 0 else None,
            )
    axes.set_xticks(np.arange(len(groups)), groups)
    axes.set_ylim(0, 105)
    axes.set_ylabel("% of views")
    tidy(axes)


def cumulative(axes: Axes, values: ArrayLike, total: int, **style: Any) -> None:
    """Draw which share of `total` reaches at least x, for x in 0..1."""
    held = np.sort(np.asarray(values, dtype=np.float64))
    x = np.concatenate([[0.0], held, [1.0]])
    reached = np.concatenate([[len(held)], len(held) - np.arange(len(held)), [0]])
    axes.step(x, 100 * reached / max(total, 1), where="pre", **style)
