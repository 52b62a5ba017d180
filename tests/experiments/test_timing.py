"""Experiment 4, a slice of it."""

from __future__ import annotations

import pytest

from experiments.framework import MeanStd, ViewSet
from experiments.timing.cases import cases_of
from experiments.timing.experiment import run
from shared.errors import InvalidInput
from shared.schemas.route import Nothing
from shared.schemas.task import LIST_TASKS
from tests.experiments.conftest import MakeContext

WHOLE = (
    "checking the names, beside perception",
    "whole request, backend",
    "client, on top",
)


def test_times_by_stage_and_by_number_of_tasks(make_context: MakeContext) -> None:
    context = make_context("bottle1")
    before = context.sparge.call(LIST_TASKS, Nothing())
    shipped = len(before.tasks)
    findings = run(context, counts=(5, shipped + 3, shipped + 8))
    assert context.sparge.call(LIST_TASKS, Nothing()) == before
    stages, breakdown, growth, limits = findings.tables
    thesis = {row[0]: (row[4], row[8]) for row in stages.rows}
    assert thesis["primitive recovery"] == ("7.6 s", "7.6 s")
    assert thesis["recovery + reasoning + matching"] == ("9.3 s", "9.4 s")
    assert thesis["perception"] == (None, None)
    times = {row[0]: row[1] for row in stages.rows}
    assert all(isinstance(each, MeanStd) for each in times.values())
    checks = times.pop("checking the names, beside perception")
    assert checks.mean >= 0, "names that were known a moment ago take no time"  # type: ignore[union-attr]
    assert all(each.mean > 0 for each in times.values())  # type: ignore[union-attr]
    assert times["whole request, client"].mean > times["primitive recovery"].mean  # type: ignore[union-attr]
    # The only view, its two tasks, both versions.
    lines = {row[1]: [float(str(cell)) for cell in row[2:]] for row in breakdown.rows}
    assert {row[0] for row in breakdown.rows} == {"views_clean"}
    assert lines["whole request, backend"][0] == 4
    assert lines["whole request, backend"][3] == pytest.approx(100)
    assert "checking the names, beside perception" in lines
    shares = [line[3] for name, line in lines.items() if name not in WHOLE]
    assert sum(shares) == pytest.approx(100)  # the rest is what is missing
    assert lines["client, on top"][1] > 0
    assert all(0 < float(str(row[1])) < 1000 for row in limits.rows)
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
