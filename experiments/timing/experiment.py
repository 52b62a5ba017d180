"""Experiment 4 of the thesis: what a request takes, by stage and by the number of tasks."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from statistics import median

import numpy as np

from experiments.framework import Context, Experiment, Findings
from experiments.framework.asking import VERSIONS
from experiments.framework.knowledge import AddedTasks, added_tasks, affordances, name_prefix
from experiments.framework.thesis import FIGURE_6_6_TASKS
from experiments.timing.breakdown import breakdown_table
from experiments.timing.cases import Case, all_cases, cases_of
from experiments.timing.limits import limits_table
from experiments.timing.measure import Timed, counts_of, measure, of_version, time_listing
from experiments.timing.plots import growth_lines, stage_bars
from experiments.timing.tables import growth_table, stage_table
from shared.schemas.route import Nothing
from shared.schemas.task import LIST_TASKS, TaskDefinition

VIEWS_PER_PAIR = 20
COUNTS = (*FIGURE_6_6_TASKS, 1_000, 10_000)
VIEWS_PER_OBJECT = 2
"""For the breakdown, with every task of the object."""
VIEWS_PER_COUNT = 4
"""Of each pair; few, so that the machine's mood does not change between the counts."""


def run(context: Context, counts: Sequence[int] = COUNTS) -> Findings:
    """Time the thesis's three pairs one request at a time, then with more and more tasks."""
    cases = cases_of(context.catalogue(), VIEWS_PER_PAIR)
    few = cases_of(context.catalogue(), VIEWS_PER_COUNT)
    shipped = len(context.sparge.call(LIST_TASKS, Nothing()).tasks)
    measure(context, few[:1], shipped, "warming up")
    stages = measure(context, cases, shipped, "timing stages")
    every = {
        each.name: measure(
            context,
            all_cases(each, VIEWS_PER_OBJECT),
            shipped,
            f"timing {each.name}",
        )
        for each in context.views()
    }
    growth, listing = _with_more_tasks(context, few, shipped, counts)
    again = measure(context, few, shipped, "timing again with the shipped tasks")
    return Findings(
        meaning=_meaning(stages, growth),
        tables=(
            stage_table(stages),
            breakdown_table(every),
            growth_table(growth, again, listing),
            limits_table(np.random.default_rng(context.seed)),
        ),
        plots=(stage_bars(stages), growth_lines(growth)),
        records=[each.record() for each in (*stages, *chain(*every.values()), *growth, *again)],
    )


def _with_more_tasks(
    context: Context, cases: Sequence[Case], shipped: int, counts: Sequence[int]
) -> tuple[list[Timed], dict[int, float]]:
    """Time the cases with the shipped tasks, then with so many; all added ones go in the end.

    Also returns the seconds of GET /tasks by number of tasks.
    """
    held = affordances(context.sparge)
    prefix = name_prefix()
    timed = measure(context, cases, shipped, f"timing with {shipped} tasks")
    known, listing = shipped, {shipped: time_listing(context.sparge)}
    with added_tasks(context.sparge, context.console) as tasks:
        for count in sorted(set(counts)):
            if count <= known:
                continue
            _learn(tasks, prefix, held, known - shipped, count - shipped)
            known = count
            timed += measure(context, cases, known, f"timing with {known} tasks")
            listing[known] = time_listing(context.sparge)
    return timed, listing


def _learn(tasks: AddedTasks, prefix: str, held: Sequence[str], first: int, last: int) -> None:
    """Add fabricated tasks with relations to affordances that exist (thesis 6.5.1)."""
    tasks.add(
        [
            TaskDefinition(
                name=f"{prefix}_{k}",
                description="fabricated, to measure with",
                requires=(held[k % len(held)],),
                grasp=(held[(k // len(held)) % len(held)],),
            )
            for k in range(first, last)
        ]
    )


def _meaning(stages: Sequence[Timed], growth: Sequence[Timed]) -> str:
    counts = counts_of(growth)

    def total(count: int) -> float:
        return 1e3 * median(t.total for t in growth if t.tasks == count)

    spent = {
        v: 1e3 * float(np.mean([t.comparable for t in of_version(stages, v)])) for v in VERSIONS
    }
    return (
        f"What the thesis times at 9.3 and 9.4 s takes {spent['v1']:.0f} ms (Version 1) and "
        f"{spent['v2']:.0f} ms (Version 2) here, on another computer, and the whole request with "
        "perception and grasps "
        f"{1e3 * float(np.mean([t.total for t in stages])):.0f} ms on average. From "
        f"{counts[0]} to {counts[-1]} tasks the median request goes from {total(counts[0]):.0f} "
        f"to {total(counts[-1]):.0f} ms."
    )


TIMING = Experiment(
    "timing",
    "Computation time",
    "How long does a request take, where does the time go, and does it grow with the number of "
    "tasks that are known?",
    run,
    thesis="experiment 4, Table 6.6 and Figure 6.6",
)
