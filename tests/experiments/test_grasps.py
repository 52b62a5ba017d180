"""Experiment 3, a slice of it."""

from __future__ import annotations

from experiments.framework import Share
from experiments.framework.asking import Source
from experiments.framework.knowledge import added_tasks, affordances, name_prefix
from experiments.framework.thesis import TABLE_6_5
from experiments.framework.views import load
from experiments.grasps.blind import Blind, blind_tasks
from experiments.grasps.experiment import run
from shared.schemas.route import Nothing
from shared.schemas.task import LIST_TASKS
from tests.experiments.conftest import MakeContext


def test_the_blind_grasp_is_offered_the_whole_object(make_context: MakeContext) -> None:
    context = make_context("bottle1", "hammer1")
    tasks = blind_tasks(affordances(context.sparge), name_prefix())
    blind = Blind(context.sparge, {name: task.name for name, task in tasks.items()})
    (views,) = context.sets
    with added_tasks(context.sparge, context.console, list(tasks.values())):
        for file in views.files:
            view = load(file)
            result, is_whole = blind.ask(Source("set", file, views.thing(file)), view)
            assert is_whole
            assert result is not None
            assert (result.point_region == (result.point_primitive >= 0)).all()


def test_the_rarest_affordance_is_asked_for_first() -> None:
    tasks = blind_tasks(["wrap_grasp", "grasp", "cut"], "p")
    assert list(tasks) == ["cut", "grasp", "wrap_grasp"]
    assert all(task.avoids == (name,) and not task.grasp for name, task in tasks.items())


def test_grasps_of_one_view(make_context: MakeContext) -> None:
    context = make_context("bottle1")
    before = context.sparge.call(LIST_TASKS, Nothing())
    findings = run(context)
    assert context.sparge.call(LIST_TASKS, Nothing()) == before
    headline, answered, by_task = findings.tables
    lines = {row[:2]: row[2:] for row in headline.rows}
    assert lines["pouring", "bottle"][1::2] == tuple(TABLE_6_5["pouring", "bottle"].values())
    assert lines["all tasks", "views_clean"][1::2] == (None, None, None)
    assert all(
        isinstance(share, Share) and share.total == 2
        for share in lines["all tasks", "views_clean"][::2]
    )
    assert len(answered.rows) == 2
    assert len(by_task.rows) == 2
    assert len(findings.records) == 2 * 3
