"""Experiment 1 of the thesis: what it takes to teach a new task, cutting."""

from __future__ import annotations

import time
from collections.abc import Sequence

from experiments.extension.lesson import (
    AFTER,
    BEFORE,
    BUILT_IN,
    CUTTING,
    REMOVED,
    Taught,
    ask_all,
    known_task,
)
from experiments.extension.tables import bars, lessons, steps
from experiments.framework import Context, Experiment, Findings, Share
from experiments.framework.knowledge import added_tasks, name_prefix
from shared.errors import InvalidInput
from shared.schemas.task import TaskDefinition


def run(context: Context) -> Findings:
    """Ask knives and scissors for a task before it is taught, after, and when it is forgotten."""
    sparge = context.sparge
    model = known_task(sparge, CUTTING)
    lesson = TaskDefinition(
        name=f"{name_prefix()}_{CUTTING}",
        description=model.description,
        requires=model.requires,
        grasp=model.grasp,
        avoids=model.avoids,
    )
    outcomes = ask_all(context, {BUILT_IN: CUTTING, BEFORE: lesson.name})
    if not outcomes:
        raise InvalidInput("none of these views shows a thing for cutting")
    with added_tasks(sparge, context.console) as tasks:
        started = time.perf_counter()
        tasks.add([lesson])
        taught_ms = 1e3 * (time.perf_counter() - started)
        outcomes += ask_all(context, {AFTER: lesson.name})
    outcomes += ask_all(context, {REMOVED: lesson.name})
    return Findings(
        meaning=_meaning(outcomes, taught_ms),
        tables=(lessons(outcomes), steps(lesson, outcomes, taught_ms)),
        plots=(bars(outcomes),),
        records=[{"stage": each.stage, **each.asked.record()} for each in outcomes],
    )


def _meaning(outcomes: Sequence[Taught], taught_ms: float) -> str:
    def grasped(stage: str, version: str) -> Share:
        return Share.of(
            each.asked.grasp_in_region
            for each in outcomes
            if (each.stage, each.asked.reasoning) == (stage, version)
        )

    return (
        f"One POST /tasks of {taught_ms:.0f} ms teaches Version 2 to hold knives and scissors by "
        f"the handle: the best grasp is there in {grasped(AFTER, 'v2').brief()} views, where it "
        "knew no such task before. Version 1 needs a rule of its own that cannot be "
        f"added at run time; with the one that is built in it is {grasped(BUILT_IN, 'v1').brief()}."
    )


EXTENSION = Experiment(
    "extension",
    "Extension to a new task",
    "What does it take to teach SPaRGE the task cutting, and does it then hold knives and "
    "scissors by the handle?",
    run,
    thesis="experiment 1",
)
