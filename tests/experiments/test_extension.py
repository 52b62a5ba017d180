"""Experiment 1, a slice of it."""

from __future__ import annotations

import pytest

from experiments.extension.experiment import run
from shared.errors import InvalidInput
from shared.schemas.route import Nothing
from shared.schemas.task import LIST_TASKS
from tests.experiments.conftest import MakeContext


def test_a_knife_before_and_after_the_lesson(make_context: MakeContext) -> None:
    context = make_context("knife1", "bottle1")
    before = context.sparge.call(LIST_TASKS, Nothing())
    findings = run(context)
    assert context.sparge.call(LIST_TASKS, Nothing()) == before
    lessons, steps = findings.tables
    task_is = {(row[2], row[3]): row[4] for row in lessons.rows}
    assert {row[1] for row in lessons.rows} == {"knife1"}
    assert task_is == {
        ("v1", "before"): "unknown",
        ("v1", "after"): "unknown",
        ("v1", "removed again"): "unknown",
        ("v1", "built in"): "known",
        ("v2", "before"): "unknown",
        ("v2", "after"): "known",
        ("v2", "removed again"): "unknown",
        ("v2", "built in"): "known",
    }
    rows = {row[3]: row[5:] for row in lessons.rows if row[2] == "v2"}
    assert rows["after"] == rows["built in"]
    assert [row[1] for row in steps.rows] == ["no", "yes"]
    assert "1/1 views" in str(steps.rows[1][4])


def test_without_a_thing_for_cutting_there_is_no_experiment(make_context: MakeContext) -> None:
    with pytest.raises(InvalidInput, match="none of these views"):
        run(make_context("bottle1"))
