"""Experiment 3 of the thesis: whether the chosen grasp holds the part that is right for the task.

The thesis compares with a data-driven approach that is blind to the task: of all
grasps on the object it takes the one with the highest score. POST /grasp has no
such mode, but the public contract can be asked for it: a Version 2 task that only
avoids an affordance, added through POST /tasks, is held by all the parts without
that affordance. Where no part of an object has it, that is the whole object, and
the best grasp of the answer is the best one whatever the task.

A grasp on the right part is worth nothing if the object drops. So the best grasp of
every answer is also replayed by physics, on the object as it really is (`judged.py`).
"""

from __future__ import annotations

from collections.abc import Sequence

from experiments.framework import (
    Asked,
    Context,
    Experiment,
    Findings,
    Share,
    ShownView,
    Table,
    ask,
)
from experiments.framework.asking import VERSIONS, Source, each_view
from experiments.framework.knowledge import added_tasks, affordances, name_prefix
from experiments.framework.replay import GRIPPER, Replays
from experiments.grasps.blind import Blind, blind_row, blind_tasks
from experiments.grasps.judged import Judged, judge, shares
from experiments.grasps.physics_tables import outcomes_table, physics_by_class, physics_table
from experiments.grasps.sheet import failed, failure_sheet
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
from shared.schemas.grasp import LIST_GRIPPERS
from shared.schemas.gripper import ParallelGripper
from shared.schemas.route import Nothing


def run(context: Context) -> Findings:
    """Ask for the blind grasp of every view, and for the grasp of each of its tasks."""
    known = affordances(context.sparge)
    if not known:
        raise InvalidInput("the backend knows no affordances, so a blind grasp cannot be asked for")
    lessons = blind_tasks(known, name_prefix())
    blind = Blind(context.sparge, {name: task.name for name, task in lessons.items()})
    replays = Replays(context.sparge)
    sets = context.views()
    meshes = {views.name: views.objects for views in sets}

    def all_methods(source: Source, view: ShownView) -> list[tuple[list[Judged], bool]]:
        result, is_whole = blind.ask(source, view)
        thing = meshes[source.set_name].get(source.file.object_name)
        rows = []
        for task in view.tasks:
            answers = [(blind_row(source, view, task, result), result)]
            answers += [
                ask(context.sparge, source, view, task, version, max_grasps=1, explain=False)
                for version in VERSIONS
            ]
            rows += [
                judge(replays, view, thing, asked, answer)
                for asked, answer in answers
                if asked.known
            ]
        return [(rows, is_whole)]

    with added_tasks(context.sparge, context.console, list(lessons.values())):
        answers = each_view(
            all_methods,
            sets,
            workers=context.workers,
            console=context.console,
            describe="asking for grasps",
        )
    judged = [each for rows, _ in answers for each in rows]
    asked = [each.asked for each in judged]
    all_whole = Share.of(is_whole for _, is_whole in answers)
    failures = failed(judged)
    return Findings(
        meaning=_meaning(asked) + _physics_meaning(judged),
        tables=(
            headline(asked, all_whole),
            *_physics(judged),
            answered_table(asked),
            by_task(asked),
        ),
        plots=(
            bars(asked),
            *([failure_sheet(sets, failures, _hand(context))] if failures else []),
        ),
        records=[each.record() for each in judged],
    )


def _physics(judged: Sequence[Judged]) -> tuple[Table, ...]:
    if not any(each.tried for each in judged):
        return ()
    return physics_table(judged), physics_by_class(judged), outcomes_table(judged)


def _hand(context: Context) -> ParallelGripper:
    """Return the hand that replays, as the backend knows it."""
    known = context.sparge.call(LIST_GRIPPERS, Nothing()).grippers
    (hand,) = (gripper for gripper in known if gripper.name == GRIPPER)
    assert isinstance(hand, ParallelGripper)
    return hand


def _physics_meaning(judged: Sequence[Judged]) -> str:
    own = [each for each in judged if each.tried and each.asked.reasoning == "v2"]
    if not own:
        return ""
    _, lifted, held, both = shares(own)
    return (
        f" Replayed by physics, {100 * lifted.value:.0f} % of the grasps of Version 2 lift the "
        f"object, {100 * held.value:.0f} % keep it when it is shaken and tilted, and "
        f"{100 * both.value:.0f} % do so by the right part."
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
    "Does the grasp that is chosen hold the part that is right for the task, would the best grasp "
    "do so by itself, without knowing the task, and does the object stay in the hand?",
    run,
    noisy_views=5,
    thesis="experiment 3, Table 6.5",
)
