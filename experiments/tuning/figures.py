"""Pictures of a search: how the cost fell, and which values the good trials share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from numpy.typing import NDArray

from experiments.framework.experiment import Plot
from experiments.framework.plots import OTHER, THESIS, V1, V2, new_figure, tidy
from experiments.tuning.space import SPACE, Tuned
from experiments.tuning.study import Trial

Array = NDArray[np.float64]

THESIS_COST, THESIS_TRIAL = 0.2, 113
"""The lowest cost of the thesis's study, and when it was reached (Figure A.1)."""


def history(trials: Sequence[Trial], published: Mapping[str, float]) -> Plot:
    """Draw every trial's cost, the lowest so far, and the published parameters' cost."""
    figure = new_figure(9.0, 4.2)
    axes = figure.subplots()
    numbers = [each.number for each in trials]
    costs = [each.cost for each in trials]
    axes.scatter(numbers, costs, s=14, color=V1, alpha=0.6, label="trial")
    axes.step(numbers, np.minimum.accumulate(costs), where="post", color=V2, label="lowest so far")
    for (name, cost), line in zip(published.items(), ("--", ":"), strict=False):
        axes.axhline(cost, color=OTHER, linestyle=line, label=f"values of the {name}")
    axes.axhline(
        THESIS_COST,
        color=THESIS,
        label=f"thesis's lowest, on its own objects (trial {THESIS_TRIAL})",
    )
    axes.set(xlabel="trial", ylabel="cost", ylim=(0, 1.05))
    axes.legend(fontsize=9, ncols=2, loc="lower left")
    tidy(axes)
    return Plot(
        "history",
        "Cost of every trial (Figure A.1 of the thesis). 1 is the worst: in no view the "
        "expected number of primitives.",
        figure,
    )


def parallel_coordinates(trials: Sequence[Trial]) -> Plot:
    """Draw every trial as a line through its parameters and its cost, the best ones on top."""
    figure = new_figure(11.0, 4.8)
    axes = figure.subplots()
    costs = np.array([each.cost for each in trials])
    low, high = float(costs.min()), max(float(costs.max()), float(costs.min()) + 1e-6)
    heights = np.column_stack(
        [[_height(tuned, each) for each in trials] for tuned in SPACE]
        + [(costs - low) / (high - low)]
    )
    colours = ScalarMappable(Normalize(low, high), "viridis")
    places = range(heights.shape[1])
    for index in np.argsort(-costs, kind="stable"):
        share = 1 - (costs[index] - low) / (high - low)
        axes.plot(
            places, heights[index], color=colours.to_rgba(costs[index]), lw=0.6 + share,
            alpha=0.25 + 0.6 * share,
        )  # fmt: skip
    axes.plot(places, heights[costs.argmin()], color="#C23B22", lw=2.2, label="best trial")
    ends = [_ends(tuned) for tuned in SPACE] + [(f"{low:.2f}", f"{high:.2f}")]
    names = [tuned.name.replace("_", "\n") for tuned in SPACE] + ["cost"]
    for place, (bottom, top) in zip(places, ends, strict=True):
        axes.axvline(place, color="#999999", lw=0.8, zorder=0)
        axes.text(place, -0.03, bottom, ha="center", va="top", fontsize=8)
        axes.text(place, 1.03, top, ha="center", va="bottom", fontsize=8)
    axes.set_xticks(places, names, fontsize=9)
    axes.tick_params(axis="x", length=0, pad=16)
    axes.set_yticks([])
    axes.set(ylim=(-0.02, 1.02), xlim=(-0.3, places[-1] + 0.3))
    for side in axes.spines.values():
        side.set_visible(False)
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, 1.16), fontsize=9, frameon=False)
    figure.colorbar(colours, ax=axes, label="cost")
    return Plot(
        "parallel-coordinates",
        "Every trial as a line through its values; dark and heavy lines are cheap. Where they "
        "gather on an axis, the parameter matters; where they spread, it does not.",
        figure,
    )


def _height(tuned: Tuned, trial: Trial) -> float:
    value = float(getattr(trial.parameters, tuned.name))
    if tuned.low is None or tuned.high is None:
        return value
    if tuned.log:
        return float(np.log(value / tuned.low) / np.log(tuned.high / tuned.low))
    return (value - tuned.low) / (tuned.high - tuned.low)


def _ends(tuned: Tuned) -> tuple[str, str]:
    if tuned.low is None or tuned.high is None:
        return "false", "true"
    return f"{tuned.low:g}", f"{tuned.high:g}"
