"""The plots of experiment 4."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median

import numpy as np

from experiments.framework import Plot
from experiments.framework.asking import VERSION_NAMES, VERSIONS
from experiments.framework.plots import COLOURS, THESIS, new_figure, tidy
from experiments.framework.thesis import FIGURE_6_6_TASKS, TABLE_6_6
from experiments.timing.measure import CHECKS, STAGES, Timed, counts_of, of_version


def stage_bars(timed: Sequence[Timed]) -> Plot:
    """Draw the mean time of every stage, one after the other."""
    figure = new_figure(9.0, 2.6)
    axes = figure.subplots()
    colours = ("#BBBBBB", "#6BAED6", "#2F6DB5", "#D9792B", "#3A8F5C", "#8E6BB0")
    in_turn = [each for each in STAGES if each[0] != CHECKS]
    for row, version in enumerate(VERSIONS):
        left = 0.0
        for (stage, name, _), colour in zip(in_turn, colours, strict=True):
            width = 1e3 * float(
                np.mean([t.stages.get(stage, 0.0) for t in of_version(timed, version)])
            )
            axes.barh(row, width, left=left, color=colour, label=name if row == 0 else None)
            left += width
    axes.set_yticks(range(len(VERSIONS)), [VERSION_NAMES[version] for version in VERSIONS])
    axes.invert_yaxis()
    axes.set_xlabel("mean ms per request")
    tidy(axes)
    figure.legend(loc="outside lower center", ncols=6, fontsize=8, frameon=False)
    return Plot("stages", "Where the milliseconds of a request go, by stage.", figure)


def growth_lines(timed: Sequence[Timed]) -> Plot:
    """Draw the median times against the number of tasks."""
    counts = counts_of(timed)
    figure = new_figure(9.0, 4.6)
    axes = figure.subplots()
    for version, name in VERSION_NAMES.items():
        for label, style, value in (
            ("whole request", "-", "total"),
            ("recovery + reasoning + matching", "--", "comparable"),
            ("reasoning", ":", "reasoning_stage"),
        ):
            axes.plot(
                counts,
                [
                    1e3
                    * median(
                        getattr(t, value) for t in of_version(timed, version) if t.tasks == count
                    )
                    for count in counts
                ],
                style,
                color=COLOURS[name],
                marker="o",
                markersize=3.5,
                label=f"{name}: {label}",
            )
        total = TABLE_6_6["total"][version]
        assert isinstance(total, float)
        axes.plot(
            FIGURE_6_6_TASKS[:: len(FIGURE_6_6_TASKS) - 1],
            [1e3 * total] * 2,
            color=THESIS,
            label=f"thesis, {name}",
        )
    axes.set(xscale="log", yscale="log", xlabel="tasks", ylabel="median ms")
    figure.legend(loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    tidy(axes)
    return Plot(
        "tasks",
        "Median time against the number of tasks, both axes logarithmic. The thesis's total is "
        "drawn as the constant that its text states, from 5 to 200 tasks.",
        figure,
    )
