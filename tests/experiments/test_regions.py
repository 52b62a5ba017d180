"""Experiment 2, a slice of it."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from experiments.framework import Share
from experiments.framework.asking import Source, ask
from experiments.framework.report import save
from experiments.framework.views import load
from experiments.regions.experiment import REGIONS, run
from tests.experiments.conftest import MakeContext

RUN = {"date": "today", "command": "sparge experiment regions", "machine": "this one"}


def test_regions_of_two_views(make_context: MakeContext, tmp_path: Path) -> None:
    context = make_context("bottle1", "can1")
    findings = run(context)
    headline, by_task, by_object = findings.tables
    assert [row[:2] for row in headline.rows[:2]] == [("views_clean", "v1"), ("views_clean", "v2")]
    assert headline.rows[0][2].total == 3  # type: ignore[union-attr]
    refused = [row[-1] for row in headline.rows[:2]]
    assert all(isinstance(share, Share) and share.total == 8 for share in refused)
    assert {row[0] for row in by_task.rows} == {"pouring", "handover"}
    # Beside them stands the thesis's line of the same task and class.
    lines = {(row[0], row[1], row[2]): row[4] for row in by_task.rows}
    assert lines["pouring", "bottle", "v2"] == Share(11, 30)
    assert lines["handover", "can", "v1"] is None
    assert len(by_object.rows) == 6
    assert [plot.name for plot in findings.plots] == [
        "found-and-good-0", "iou", "examples-v1", "examples-v2",
    ]  # fmt: skip
    page = save(tmp_path, REGIONS, findings, RUN)
    text = (tmp_path / "regions" / "requests.csv").read_text(encoding="utf-8")
    requests = list(csv.DictReader(text.splitlines()))
    assert len(requests) == 2 * 3 + 2 * 8
    assert all(row["thesis_tpr"] == row["precision"] for row in requests)
    assert "Grasp regions" in page.read_text(encoding="utf-8")


def test_scores_are_those_of_the_public_answer(make_context: MakeContext) -> None:
    context = make_context("bottle1")
    (views,) = context.sets
    file = views.files[0]
    view = load(file)
    source = Source("set", file, views.thing(file))
    asked, result = ask(context.sparge, source, view, "handover", "v2")
    assert result is not None
    assert asked.found == result.answer.found
    assert asked.score is not None
    predicted = result.point_region.reshape(view.view.label.shape)
    truth = view.view.region("handover")
    expected = (predicted & truth).sum() / (predicted & view.view.on_object | truth).sum()
    assert asked.score.iou == pytest.approx(expected)


def test_a_view_that_is_refused_counts_as_not_found(make_context: MakeContext) -> None:
    context = make_context("bottle1")
    (views,) = context.sets
    file = views.files[0]
    view = load(file)
    empty = view.without(np.ones(view.view.depth.shape, dtype=bool))
    asked, result = ask(
        context.sparge, Source("set", file, views.thing(file)), empty, "pouring", "v1"
    )
    assert result is None
    assert asked.error
    assert not any((asked.found, asked.refused, asked.good))
    assert asked.known
