"""Parts against labels: choices and truths with known answers, and a slice of the experiment."""

from __future__ import annotations

import csv
from dataclasses import replace
from itertools import chain, combinations
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console
from scipy.spatial.transform import Rotation

from experiments.catalogue import CatalogueObject, build
from experiments.catalogue.model import Mesh, Part
from experiments.framework import Context, Share, ViewSet
from experiments.framework.plots import png
from experiments.framework.report import save
from experiments.primitives.class_tables import class_table
from experiments.primitives.experiment import PRIMITIVES, run
from experiments.primitives.match import match
from experiments.primitives.model import METHODS, Cut, RegionCut
from experiments.primitives.sheet import worst_views
from experiments.primitives.tables import headline, size_table, time_table
from experiments.primitives.truth import true_part
from shared.client import Sparge
from shared.errors import InvalidInput
from shared.schemas.primitive import Method
from shared.superquadric import Superquadric, surface_mesh
from tests.experiments.conftest import MakeContext

RUN = {"date": "today", "command": "sparge experiment primitives", "machine": "this one"}

# Choosing among the parts


def iou(one: np.ndarray, other: np.ndarray) -> float:
    return float((one & other).sum() / (one | other).sum())


@given(st.integers(0, 2**32 - 1), st.integers(1, 6), st.integers(5, 60))
def test_the_best_choices_are_those_of_trying_all(seed: int, parts: int, points: int) -> None:
    rng = np.random.default_rng(seed)
    labels = rng.integers(-1, parts, points).astype(np.int16)
    truth = rng.random(points) < rng.random()
    truth[rng.integers(points)] = True
    ids = sorted(set(labels.tolist()) - {-1})
    found = match(labels, truth)
    if not ids:
        assert found.part is None
        assert found.single == found.union == 0
        return
    choices = chain.from_iterable(combinations(ids, k) for k in range(1, len(ids) + 1))
    assert found.union == pytest.approx(
        max(iou(np.isin(labels, choice), truth) for choice in choices)
    )
    singles = {part: iou(labels == part, truth) for part in ids}
    assert found.part is not None
    assert (
        found.single == pytest.approx(singles[found.part]) == pytest.approx(max(singles.values()))
    )


def test_a_region_of_no_points_is_no_question() -> None:
    with pytest.raises(ValueError, match="at least one"):
        match(np.zeros(3, dtype=np.int16), np.zeros(3, dtype=bool))


# What the parts really are


def thing(superquadric: Superquadric) -> CatalogueObject:
    vertices, faces = surface_mesh(superquadric)
    part = Part("it", (Mesh(np.asarray(vertices), np.asarray(faces, dtype=np.int32)),))
    return CatalogueObject("thing", "", (part,), {"throwing": ("it",)})


@pytest.mark.parametrize(
    ("exponents", "semi_axes", "shape"),
    [
        ((0.1, 0.1), (0.02, 0.05, 0.09), "cuboid"),
        ((0.1, 1.0), (0.03, 0.04, 0.09), "cylinder"),
        ((0.1, 1.0), (0.08, 0.08, 0.01), "cylinder"),
        ((1.0, 1.0), (0.04, 0.04, 0.04), "sphere"),
        ((0.55, 0.55), (0.03, 0.03, 0.05), None),
    ],
)
def test_the_truth_of_an_ideal_body_in_any_orientation(
    exponents: tuple[float, float],
    semi_axes: tuple[float, float, float],
    shape: str | None,
    rng: np.random.Generator,
) -> None:
    x, y, z, w = Rotation.random(random_state=rng).as_quat().tolist()
    body = Superquadric(exponents, semi_axes, (0.1, -0.2, 0.5), (x, y, z, w))
    found = true_part(thing(body), "throwing")
    np.testing.assert_allclose(found.extents, np.sort(body.full_extents), rtol=0.03)
    assert found.shape == shape


def test_a_pot_is_no_thin_shell() -> None:
    assert true_part(build("pan1"), "handover").shape == "cylinder"


def test_a_region_of_several_parts_is_one_body() -> None:
    bottle = build("bottle1")
    short, middle, long = true_part(bottle, "pouring").extents  # body and shoulder
    assert short == pytest.approx(middle, rel=0.01)
    whole = np.ptp(bottle.vertices, axis=0).max()
    assert 0.6 * whole < long < 0.9 * whole


# Tables


def made_up(method: Method, number: int, iou: float, seconds: float | None = 0.01) -> Cut:
    known = iou >= 0.7
    region = RegionCut(
        "pouring", iou, min(iou + 0.1, 1.0), (0.1, -0.2, 0.3) if known else None, known or None
    )
    return Cut(
        "set", "mug", "mug", str(number), method, method, (region,), 3, 500, 0.75, seconds,
        code="" if seconds else "no_object",
    )  # fmt: skip


def test_regions_that_nothing_was_found_of_count() -> None:
    cuts = [
        made_up("parts", 0, 0.9),
        made_up("parts", 1, 0.75),
        made_up("parts", 2, 0.65),
        made_up("parts", 3, 0.0, seconds=None),
        made_up("ems", 0, 0.1, seconds=0.5),
        replace(made_up("ems", 1, 0.1, seconds=0.3), answered="parts"),
    ]
    table = headline(cuts)
    first, second = (dict(zip(table.columns, row, strict=True)) for row in table.rows)
    assert first["% assigned"] == pytest.approx(75)
    assert first["one ≥ 0.7"] == Share(2, 4)
    assert first["one ≥ 0.85"] == Share(1, 4)
    assert first["several ≥ 0.7"] == Share(3, 4)
    assert first["several ≥ 0.85"] == Share(2, 4)
    assert second["method"] == "ems (answered by parts)"
    sizes = size_table(cuts)
    (line,) = (dict(zip(sizes.columns, row, strict=True)) for row in sizes.rows)  # ems has none
    assert line["compared"] == 2
    assert line["middle"] == pytest.approx(0.2)
    assert line["shape right"] == Share(2, 2)
    assert [row[2] for row in class_table(cuts).rows] == [Share(2, 4), Share(0, 2)]
    (times,) = time_table(cuts).rows
    assert times[1] == 2  # views that both methods answered
    assert list(times[-2:]) == [pytest.approx(40), pytest.approx(40)]


def test_the_worst_come_first() -> None:
    cuts = [made_up("parts", k, score) for k, score in enumerate((0.9, 0.2, 0.5))]
    cuts.append(made_up("ems", 3, 0.0))
    assert [each.view for each in worst_views(cuts, "parts", 2)] == ["1", "2"]


# All of it, on a small slice


def test_parts_of_two_views(make_context: MakeContext, few_things: ViewSet, tmp_path: Path) -> None:
    context = make_context("bottle1", "can1")
    objects = {name: build(name) for name in ("bottle1", "can1")}
    (shown,) = context.sets
    context = replace(context, sets=(replace(shown, objects=objects),))
    findings = run(context)
    table, classes, sizes, times, published, every_class, regions = findings.tables
    assert [row[1].split()[0] for row in table.rows] == list(METHODS)  # type: ignore[union-attr]
    assert all(row[2].total == 3 for row in table.rows)  # type: ignore[union-attr]
    assert times.rows[0][1] == published.rows[0][1] == 2
    assert {row[0] for row in classes.rows} == {row[0] for row in every_class.rows}
    assert {row[0] for row in classes.rows} == {"bottle", "can"}
    assert all(1 <= int(str(row[2])) <= 3 for row in sizes.rows)
    assert {row[:2] for row in regions.rows} == {
        ("bottle1", "pouring"),
        ("bottle1", "handover"),
        ("can1", "handover"),
    }
    assert [plot.name for plot in findings.plots] == ["iou", "sizes", "times", "worst-parts"]
    assert all(png(plot.figure).startswith(b"\x89PNG") for plot in findings.plots)
    save(tmp_path, PRIMITIVES, findings, RUN)
    text = (tmp_path / "primitives" / "requests.csv").read_text(encoding="utf-8")
    rows = list(csv.DictReader(text.splitlines()))
    assert len(rows) == 3 * len(METHODS)
    assert all(0 <= float(row["single_iou"]) <= float(row["union_iou"]) <= 1 for row in rows)
    # A can is one part, and both methods can tell how large it is.
    cans = [row for row in rows if row["object"] == "can1"]
    assert all(float(row["single_iou"]) > 0.7 for row in cans)
    assert all(abs(float(row["log_error_longest"])) < 0.5 for row in cans)
    assert all(float(row["assigned"]) > 0.9 for row in cans)


def test_without_views_there_is_no_experiment(sparge: Sparge, tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="no views"):
        run(Context(sparge, Console(quiet=True), tmp_path, (ViewSet("none", ()),)))
