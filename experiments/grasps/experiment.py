"""Experiment 3 of the thesis: whether the chosen grasp holds the part that is right for the task.

The thesis compares with a data-driven approach that is blind to the task: of all
grasps on the object it takes the one with the highest score. POST /grasp has no
such mode, but the public contract can be asked for it: a Version 2 task that only
avoids an affordance, added through POST /tasks, is held by all the parts without
that affordance. Where no part of an object has it, that is the whole object, and
the best grasp of the answer is the best one whatever the task.
"""

from __future__ import annotations

from collections.abc import Sequence

from experiments.framework import Asked, Context, Experiment, Findings, Share, ShownView, ask
from experiments.framework.asking import VERSIONS, Source, each_view
from experiments.framework.knowledge import added_tasks, affordances, name_prefix
from experiments.grasps.blind import Blind, blind_row, blind_tasks
from experiments.grasps.tables import (
    METHODS,
    answered_table,
    bars,
    by_task,
    headline,
    success,
    where_answered,
)
from shared.errors import InvalidInput


def run(context: Context) -> Findings:
    """Ask for the blind grasp of every view, and for the grasp of each of its tasks."""
    known = affordances(context.sparge)
    if not known:
        raise InvalidInput("the backend knows no affordances, so a blind grasp cannot be asked for")
    lessons = blind_tasks(known, name_prefix())
    blind = Blind(context.sparge, {name: task.name for name, task in lessons.items()})

    def all_methods(source: Source, view: ShownView) -> list[tuple[list[Asked], bool]]:
        result, is_whole = blind.ask(source, view)
        rows = []
        for task in view.tasks:
            rows.append(blind_row(source, view, task, result))
            rows += [
                ask(context.sparge, source, view, task, version, max_grasps=1, explain=False)[0]
                for version in VERSIONS
            ]
        return [(rows, is_whole)]

    with added_tasks(context.sparge, context.console, list(lessons.values())):
        answers = each_view(
            all_methods,
            context.views(),
            workers=context.workers,
            console=context.console,
            describe="asking for grasps",
        )
    asked = [each for rows, _ in answers for each in rows if each.known]
    all_whole = Share.of(is_whole for _, is_whole in answers)
    return Findings(
        meaning=_meaning(asked),
        tables=(headline(asked, all_whole), answered_table(asked), by_task(asked)),
        plots=(bars(asked),),
        records=[each.record() for each in asked],
    )


def _meaning(asked: Sequence[Asked]) -> str:
    first = asked[0].source
    own = [each for each in asked if each.source == first]
    blind, v1, v2 = (100 * success(own, method).value for method in METHODS)
    answered = {
        version: tuple(100 * share.value for share in where_answered(own, version))
        for version in VERSIONS
    }
    return (
        f"Over all views called {first}, the best grasp is on the right part in {v1:.0f} % "
        f"(Version 1) and {v2:.0f} % (Version 2), against {blind:.0f} % for the task-blind one, "
        "which always has a part to hold. Where a version does answer with a grasp, it is right "
        f"in {answered['v1'][0]:.0f} % (Version 1; the blind one in {answered['v1'][1]:.0f} % of "
        f"the same views) and {answered['v2'][0]:.0f} % (Version 2; blind "
        f"{answered['v2'][1]:.0f} %)."
    )


GRASPS = Experiment(
    "grasps",
    "Grasps on the right part",
    "Does the grasp that is chosen hold the part that is right for the task, and would the best "
    "grasp do so by itself, without knowing the task?",
    run,
    thesis="experiment 3, Table 6.5",
)
