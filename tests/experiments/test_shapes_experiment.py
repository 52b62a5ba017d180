"""A slice of the experiment: tables, pictures, the line about human labels."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from rich.console import Console

from experiments.framework import Context, Findings
from experiments.framework.plots import png
from experiments.shapes.criterion import names
from experiments.shapes.dataset import thesis_superquadrics
from experiments.shapes.experiment import SHAPES, shapes
from experiments.shapes.thesis import TABLE_A_2
from shared.errors import NotFound


def context(folder: Path) -> Context:
    # The experiment asks no backend.
    return Context(
        sparge=cast("Any", None), console=Console(quiet=True), folder=folder, limit=1, seed=4
    )


@pytest.fixture(scope="module")
def findings(tmp_path_factory: pytest.TempPathFactory) -> Findings:
    folder = tmp_path_factory.mktemp("shapes")
    rows = thesis_superquadrics(120, np.random.default_rng(8))
    table = np.column_stack([rows, names(rows)])
    np.savetxt(folder / "human.csv", table, delimiter=",", header="e1,e2,a1,a2,a3,class")
    return shapes(folder / "human.csv").run(context(folder))


def test_the_headline_is_table_a_2(findings: Findings) -> None:
    table = findings.tables[0]
    ours = {row[0]: row for row in reversed(table.rows)}
    for method, theirs in TABLE_A_2.items():
        assert ours[method][-5:] == theirs
    f1 = table.columns.index("F1")
    assert cast("float", ours["MLP"][f1]) > cast("float", ours["heuristic"][f1]) + 0.2
    assert cast("float", ours["shipped model"][f1]) > cast("float", ours["MLP"][f1])


def test_human_labels_get_their_line_and_table(findings: Findings) -> None:
    assert findings.meaning.startswith("human labels: F1 0.9")
    table = next(each for each in findings.tables if each.name == "human-labels")
    # These people are the criterion itself.
    assert [row[0] for row in table.rows if row[2] == 1.0] == ["criterion"]


def test_probabilities_are_held_to_the_goal(findings: Findings) -> None:
    table = next(each for each in findings.tables if each.name == "calibration")
    assert [row[0] for row in table.rows] == ["all kinds", "as in A.1.2", "human labels"]
    assert all(cast("float", row[3]) < 0.08 for row in table.rows)


def test_the_pictures_can_be_drawn(findings: Findings) -> None:
    assert [plot.name for plot in findings.plots] == ["confusion", "reliability", "borders"]
    for plot in findings.plots:
        assert png(plot.figure).startswith(b"\x89PNG")


def test_a_missing_file_is_told_before_anything_is_done(tmp_path: Path) -> None:
    assert SHAPES.views_per_object is None
    with pytest.raises(NotFound, match="none"):
        shapes(tmp_path / "none.csv").run(context(tmp_path))
