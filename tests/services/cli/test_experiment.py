"""`sparge experiment`, as far as it is the command's own."""

from __future__ import annotations

import os
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from experiments.dataset import DatasetOptions, make_dataset
from experiments.framework.experiment import Experiment
from experiments.registry import experiment as experiment_named
from experiments.tuning.experiment import TRIALS
from services.cli.experiment import experiment, own_backend
from shared.errors import InvalidInput
from shared.schemas.route import Nothing
from shared.schemas.task import ADD_TASK, LIST_TASKS, TaskDefinition


def test_the_command_prints_tables_and_writes_the_report(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    make_dataset(tmp_path / "data", DatasetOptions(views=1, objects=("can1",)))
    results = tmp_path / "results"
    experiment(
        "regions",
        scans=[tmp_path / "data" / "views_clean"],
        catalogue=False,
        limit=1,
        results=results,
        seed=0,
        workers=1,
    )
    printed = capsys.readouterr()
    assert "Regions: all tasks together" in printed.out
    assert "report:" in printed.err
    page = (results / "report.html").read_text(encoding="utf-8")
    for word in ("Grasp regions", "machine", "SPaRGE", "in this process", "views_clean"):
        assert word in page
    assert (results / "regions" / "regions.csv").exists()


def test_nothing_to_ask_about_is_said_before_a_backend_starts(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="nothing to ask about"):
        experiment("regions", catalogue=False, results=tmp_path)
    with pytest.raises(InvalidInput, match="there are regions, primitives, grasps"):
        experiment("juggling", results=tmp_path)
    with pytest.raises(InvalidInput, match="only shapes takes human labels, not regions"):
        experiment("regions", human_labels=tmp_path, results=tmp_path)
    with pytest.raises(InvalidInput, match="only tuning takes trials, not shapes"):
        experiment("shapes", trials=3, results=tmp_path)
    with pytest.raises(InvalidInput, match="no random objects"):
        experiment("grasps", variants=2, catalogue=False, scans=[tmp_path], results=tmp_path)
    with pytest.raises(InvalidInput, match="no random objects"):
        experiment("shapes", variants=2, results=tmp_path)


def test_random_objects_are_looked_at_as_well(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[int] = []

    def views(wanted: Experiment, *_: Any, **__: Any) -> None:
        asked.append(wanted.variants)
        raise InvalidInput("seen")

    monkeypatch.setattr("experiments.framework.conduct.view_sets", views)
    for name, variants in (("grasps", None), ("grasps", 3), ("primitives", None)):
        with pytest.raises(InvalidInput, match="seen"):
            experiment(name, variants=variants, results=tmp_path)
    assert asked == [0, 3, 4]


def test_so_many_trials_are_searched() -> None:
    asked = experiment_named("tuning", trials=7).run
    assert isinstance(asked, partial)
    assert asked.keywords == {"trials": 7}
    usual = experiment_named("tuning").run
    assert isinstance(usual, partial)
    assert usual.keywords == {"trials": TRIALS}


def test_an_experiment_neither_sees_nor_keeps_tasks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    users = tmp_path / "knowledge"
    monkeypatch.setenv("SPARGE_REASONING_KNOWLEDGE_DIR", str(users))
    for _ in range(2):
        with own_backend(None) as sparge:
            known = {task.name for task in sparge.call(LIST_TASKS, Nothing()).tasks}
            assert "watering" not in known
            sparge.call(ADD_TASK, TaskDefinition(name="watering", grasp=("wrap_grasp",)))
    assert os.environ["SPARGE_REASONING_KNOWLEDGE_DIR"] == str(users)
    assert not users.exists()
