"""Experiment 1, a slice of it."""

from __future__ import annotations

import pytest
from rich.console import Console

from experiments.extension.experiment import run
from experiments.extension.lesson import known_task
from experiments.extension.teaching import lesson_on, taught
from shared.client import Sparge
from shared.errors import InvalidInput
from shared.schemas.route import Nothing
from shared.schemas.rule import LIST_RULES
from shared.schemas.task import LIST_AFFORDANCES, LIST_TASKS
from tests.experiments.conftest import MakeContext


def test_a_knife_before_and_after_the_lesson(make_context: MakeContext) -> None:
    context = make_context("knife1", "bottle1")
    before = context.sparge.call(LIST_TASKS, Nothing())
    findings = run(context)
    assert context.sparge.call(LIST_TASKS, Nothing()) == before
    assert context.sparge.call(LIST_RULES, Nothing()).rules == ()
    lessons, steps = findings.tables
    task_is = {(row[2], row[3]): row[4] for row in lessons.rows}
    assert {row[1] for row in lessons.rows} == {"knife1"}
    assert task_is == {
        (version, stage): "known" if stage in ("after", "built in") else "unknown"
        for version in ("v1", "v2")
        for stage in ("before", "after", "removed again", "built in")
    }
    for version in ("v1", "v2"):
        rows = {row[3]: row[5:] for row in lessons.rows if row[2] == version}
        assert rows["after"] == rows["built in"]
        assert rows["after"] != rows["before"], "the knife is held once the task is known"
    assert [row[1] for row in steps.rows] == ["yes", "yes"]
    assert "12 and 8 conditions on 2 parts" in str(steps.rows[0][2])
    assert "requires cut, grasp; grasp grasp; avoids cut" in str(steps.rows[1][2])


def versions_knowing(sparge: Sparge, name: str) -> tuple[str, ...]:
    known = {task.name: task.reasoning for task in sparge.call(LIST_TASKS, Nothing()).tasks}
    return known.get(name, ())


def test_the_lesson_is_forgotten_after_an_error(sparge: Sparge) -> None:
    lesson = lesson_on(known_task(sparge, "cutting"), "experiment_0_test")
    affordances = sparge.call(LIST_AFFORDANCES, Nothing())
    seen = []

    def interrupted() -> None:
        with taught(sparge, Console(quiet=True), lesson):
            seen.append(versions_knowing(sparge, lesson.name))
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert seen == [("v1", "v2")]
    assert versions_knowing(sparge, lesson.name) == ()
    assert sparge.call(LIST_RULES, Nothing()).rules == ()
    assert sparge.call(LIST_AFFORDANCES, Nothing()) == affordances


def test_without_a_thing_for_cutting_there_is_no_experiment(make_context: MakeContext) -> None:
    with pytest.raises(InvalidInput, match="none of these views"):
        run(make_context("bottle1"))
