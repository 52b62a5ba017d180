"""Experiment 4, a slice of it."""

from __future__ import annotations

import pytest

from experiments.framework import MeanStd, ViewSet
from experiments.timing.experiment import run
from experiments.timing.measure import cases_of
from shared.errors import InvalidInput
from shared.schemas.route import Nothing
from shared.schemas.task import LIST_TASKS
from tests.experiments.conftest import MakeContext


def test_times_by_stage_and_by_number_of_tasks(make_context: MakeContext) -> None:
    context = make_context("bottle1")
    before = context.sparge.call(LIST_TASKS, Nothing())
    shipped = len(before.tasks)
    findings = run(context, counts=(5, shipped + 3, shipped + 8))
    assert context.sparge.call(LIST_TASKS, Nothing()) == before
    stages, growth = findings.tables
    thesis = {row[0]: (row[4], row[8]) for row in stages.rows}
    assert thesis["primitive recovery"] == ("7.6 s", "7.6 s")
    assert thesis["recovery + reasoning + matching"] == ("9.3 s", "9.4 s")
    assert thesis["perception"] == (None, None)
    times = {row[0]: row[1] for row in stages.rows}
    assert all(isinstance(each, MeanStd) and each.mean > 0 for each in times.values())
    assert times["whole request, client"].mean > times["primitive recovery"].mean  # type: ignore[union-attr]
    # 5 cannot be reached from above; the shipped tasks stand for it.
    assert [row[0] for row in growth.rows] == [
        str(shipped), str(shipped + 3), str(shipped + 8), f"{shipped} again",
    ]  # fmt: skip


def test_the_thesiss_pairs_are_timed_over_all_objects(few_things: ViewSet) -> None:
    cases = cases_of(few_things, 20)
    assert {(case.task, case.class_name) for case in cases} == {
        ("handover", "bottle"),
        ("hammering", "hammer"),
    }


def test_things_of_unknown_class_are_timed_at_their_first_task(few_things: ViewSet) -> None:
    unknown = ViewSet("scans", few_things.files)
    assert [case.task for case in cases_of(unknown, 1)] == [
        "pouring",
        "handover",
        "hammering",
    ]
    with pytest.raises(InvalidInput, match="no views"):
        cases_of(ViewSet("none", ()), 1)
