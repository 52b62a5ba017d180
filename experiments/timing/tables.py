"""The tables of experiment 4."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import median

import numpy as np

from experiments.framework import MeanStd, Table
from experiments.framework.asking import VERSIONS
from experiments.framework.cells import Cell
from experiments.framework.thesis import TABLE_6_6
from experiments.timing.measure import STAGES, Timed, counts_of, of_version


def stage_table(timed: Sequence[Timed]) -> Table:
    """Return one line for each stage, both versions, Table 6.6 beside them."""
    rows: list[tuple[Cell, ...]] = []
    for stage, name, counterparts in STAGES:
        rows.append(
            (
                name,
                *(
                    cell
                    for version in VERSIONS
                    for cell in (
                        *_figures([t.stages.get(stage, 0.0) for t in of_version(timed, version)]),
                        _thesis_seconds(counterparts, version),
                    )
                ),
            )
        )
    for name, value, counterparts in (
        ("recovery + reasoning + matching", "comparable", ("total",)),
        ("whole request, backend", "total", ()),
        ("whole request, client", "seen", ()),
    ):
        rows.append(
            (
                name,
                *(
                    cell
                    for version in VERSIONS
                    for cell in (
                        *_figures([getattr(t, value) for t in of_version(timed, version)]),
                        _thesis_seconds(counterparts, version),
                    )
                ),
            )
        )
    return Table(
        "stages",
        "Milliseconds by stage, beside the thesis's Table 6.6",
        (
            "stage",
            "v1 ms",
            "v1 median",
            "v1 p95",
            "thesis v1",
            "v2 ms",
            "v2 median",
            "v2 p95",
            "thesis v2",
        ),
        tuple(rows),
        f"{len(timed)} requests, one at a time: {', '.join(_pairs(timed))}. ms: mean ± standard "
        "deviation. Stages are measured at the gateway, so they hold the way there and back. The "
        "names of task and gripper are checked while perception works. The "
        "thesis's figures are for a Core i7-9750H and leave out perception and grasp detection; "
        "its superquadrics, overlap removal and shape classification (2.3 + 4.3 + 1.0 s) are our "
        "primitive recovery.",
    )


def growth_table(
    timed: Sequence[Timed], again: Sequence[Timed], listing: Mapping[int, float]
) -> Table:
    """Return one line for each number of tasks; `listing` is seconds of GET /tasks."""
    lines: list[tuple[str, list[Timed], float | None]] = [
        (str(count), [t for t in timed if t.tasks == count], 1e3 * listing[count])
        for count in counts_of(timed)
    ]
    lines += [(f"{count} again", list(again), None) for count in counts_of(again)]
    rows: list[tuple[Cell, ...]] = []
    for name, group, listed in lines:
        cells: list[Cell] = [name]
        for version in VERSIONS:
            mine = of_version(group, version)
            cells += [
                MeanStd.of((1e3 * t.comparable for t in mine), 1),
                1e3 * median(t.reasoning_stage for t in mine),
                1e3 * median(t.total for t in mine),
            ]
        rows.append((*cells, listed))
    return Table(
        "tasks",
        "Milliseconds by number of tasks, as in the thesis's Figure 6.6",
        (
            "tasks",
            "v1 comparable",
            "v1 reasoning, median",
            "v1 request, median",
            "v2 comparable",
            "v2 reasoning, median",
            "v2 request, median",
            "GET /tasks, median",
        ),
        tuple(rows),
        "Comparable: recovery + reasoning + matching, mean ± standard deviation. The shipped tasks "
        "cannot be removed, so the first line stands for the thesis's 5. Tasks are added through "
        "POST /tasks as relations of Version 2, which is where a backend can grow at run time; "
        "Version 1 is asked with the same tasks present, its rules stay those that are shipped. "
        "The last line is measured after all were removed. The thesis prints no "
        "figures for its curves, only that the total of 9.3 s (Version 1) and 9.4 s (Version 2) "
        "does not grow from 5 to 200 tasks.",
    )


def _figures(seconds: Sequence[float]) -> tuple[MeanStd, float, float]:
    milliseconds = 1e3 * np.asarray(seconds)
    middle, high = np.percentile(milliseconds, [50, 95])
    return MeanStd.of(milliseconds, 1), float(middle), float(high)


def _thesis_seconds(counterparts: Sequence[str], version: str) -> str | None:
    """Return the thesis's seconds for what these of its stages do together."""
    figures = [TABLE_6_6[name][version] for name in counterparts]
    if not figures:
        return None
    total = sum(each.mean if isinstance(each, MeanStd) else each for each in figures)
    return f"{total:.3g} s"


def _pairs(timed: Sequence[Timed]) -> list[str]:
    return [f"{task} {name}" for task, name in dict.fromkeys((t.task, t.class_name) for t in timed)]
