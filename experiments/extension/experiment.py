"""Experiment 1 of the thesis: what it takes to teach a new task, cutting."""

from __future__ import annotations

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
from experiments.extension.teaching import Lesson, Took, lesson_on, taught
from experiments.framework import Context, Experiment, Findings, Share
from experiments.framework.knowledge import name_prefix
from shared.errors import InvalidInput


def run(context: Context) -> Findings:
    """Ask knives and scissors for a task before it is taught, after, and when it is forgotten."""
    sparge = context.sparge
    model = known_task(sparge, CUTTING)
    lesson = lesson_on(model, name_prefix())
    outcomes = ask_all(context, {BUILT_IN: CUTTING, BEFORE: lesson.name})
    if not outcomes:
        raise InvalidInput("none of these views shows a thing for cutting")
    with taught(sparge, context.console, lesson) as took:
        outcomes += ask_all(context, {AFTER: lesson.name})
    outcomes += ask_all(context, {REMOVED: lesson.name})
    return Findings(
        meaning=_meaning(outcomes, lesson, took),
        tables=(lessons(outcomes), steps(lesson, outcomes, took)),
        plots=(bars(outcomes),),
        records=[{"stage": each.stage, **each.asked.record()} for each in outcomes],
    )


def _meaning(outcomes: Sequence[Taught], lesson: Lesson, took: Took) -> str:
    def grasped(stage: str, version: str) -> str:
        return Share.of(
            each.asked.grasp_in_region
            for each in outcomes
            if (each.stage, each.asked.reasoning) == (stage, version)
        ).brief()

    return (
        f"Both versions learn to hold knives and scissors by the handle while the backend runs: "
        f"Version 1 from {len(lesson.rules)} rules of conditions (POST /rules, "
        f"{took.version_1_ms:.0f} ms), Version 2 from an affordance with its rules and relations "
        f"to it (POST /affordances, POST /tasks, {took.version_2_ms:.0f} ms). After that the best "
        "grasp is on the handle in "
        f"{grasped(AFTER, 'v1')} (Version 1) and {grasped(AFTER, 'v2')} (Version 2) views; the "
        f"shipped task reaches {grasped(BUILT_IN, 'v1')} and {grasped(BUILT_IN, 'v2')}. Before, "
        "and when the lesson is forgotten, neither knows the task."
    )


EXTENSION = Experiment(
    "extension",
    "Extension to a new task",
    "What does it take to teach SPaRGE the task cutting, and does it then hold knives and "
    "scissors by the handle?",
    run,
    thesis="experiment 1",
)
