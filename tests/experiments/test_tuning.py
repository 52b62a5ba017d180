"""The search for parameters: what is expected, what it costs, how a study goes on."""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console
from scipy.optimize import linear_sum_assignment

from experiments.catalogue import CATALOGUE, CatalogueObject, Part, build
from experiments.catalogue.shapes import box, moved
from experiments.dataset import DatasetOptions, ViewFile, make_dataset, view_files
from experiments.dataset.output import CLEAN
from experiments.framework import Context, ViewSet
from experiments.framework.plots import png
from experiments.framework.views import Thing, things_of
from experiments.tuning import run, study, tuning
from experiments.tuning.cost import size_differences, view_cost
from experiments.tuning.evaluation import tuning_views
from experiments.tuning.expected import ExpectedPrimitive, expected_primitives
from experiments.tuning.experiment import CHECKED_ON, CLASSES, TUNED_ON, split
from experiments.tuning.outcome import NAMES
from experiments.tuning.space import SPACE
from experiments.tuning.study import Trial, opened
from shared.client import Sparge
from shared.errors import Conflict, InvalidInput, StageUnavailable
from shared.geometry.rotation import frame_from_z
from shared.schemas.primitive import PRESETS, EmsParameters
from tests.support.serving import Client

HANDLE = ExpectedPrimitive(("handle",), (0.02, 0.03, 0.2), (-0.1, 0.0, 0.0))
HEAD = ExpectedPrimitive(("head",), (0.04, 0.05, 0.1), (0.02, 0.0, 0.01))
PERFECT = ([HANDLE.size, HEAD.size], [HANDLE.position, HEAD.position])


# What is expected


def test_the_smallest_box_around_what_is_held_for_the_same_tasks() -> None:
    tilt = frame_from_z((0.3, -0.5, 0.8), x_hint=(1, 0, 0))
    thing = CatalogueObject(
        "brick",
        "a brick on two feet",
        (
            Part("brick", (moved(box((0.05, 0.1, 0.2), (0, 0, 0)), (0.01, 0.02, 0.03), tilt),)),
            Part("left", (box((0.02, 0.02, 0.02), (0.0, -0.04, -0.2)),)),
            Part("right", (box((0.02, 0.02, 0.02), (0.0, 0.04, -0.2)),)),
        ),
        {"throwing": ("brick",), "handover": ("left", "right")},
    )
    brick, feet = expected_primitives(thing)
    assert (brick.parts, feet.parts) == (("brick",), ("left", "right"))
    np.testing.assert_allclose(brick.size, [0.05, 0.1, 0.2], rtol=1e-3)  # its edges are round
    np.testing.assert_allclose(brick.position, [0.01, 0.02, 0.03], atol=1e-9)
    np.testing.assert_allclose(feet.size, [0.02, 0.02, 0.1], rtol=1e-3)
    np.testing.assert_allclose(feet.position, [0, 0, -0.2], atol=1e-9)


@pytest.mark.parametrize("name", CATALOGUE)
def test_an_object_of_the_thesis_should_be_two_primitives(name: str) -> None:
    thing = build(name)
    found = expected_primitives(thing)
    held = [part for each in found for part in each.parts]
    assert sorted(held) == sorted(thing.part_names)
    if thing.class_name in CLASSES:
        assert len(found) == 2
    longest = float(np.linalg.norm(np.ptp(thing.vertices, axis=0)))
    assert all(0 < min(each.size) <= max(each.size) <= longest for each in found)


# What it costs


def test_perfect_primitives_cost_nothing_in_any_order_and_place() -> None:
    sizes, positions = np.array(PERFECT[0]), np.array(PERFECT[1])
    elsewhere = positions[::-1] + np.array([0.3, -0.2, 0.1])
    cost = view_cost(sizes[::-1][:, [2, 0, 1]], elsewhere, (HANDLE, HEAD))
    assert cost.total == pytest.approx(0, abs=1e-12)


def test_the_errors_are_those_of_the_equations() -> None:
    sizes = [(0.2, 0.03, 0.03), (0.1, 0.02, 0.05)]  # 0.01 too thick, 0.02 too thin
    positions = [HANDLE.position, (0.05, -0.01, 0.01)]  # 0.03 and 0.01 away from the handle
    cost = view_cost(sizes, positions, (HANDLE, HEAD))
    assert cost.size == pytest.approx(np.tanh(0.01 + 0.02))
    assert cost.spatial == pytest.approx(np.tanh(0.03 + 0.01))
    assert cost.total == pytest.approx((np.tanh(0.03) + np.tanh(0.04)) / 2)


def test_another_number_of_primitives_costs_one() -> None:
    sizes, positions = PERFECT
    assert view_cost(sizes[:1], positions[:1], (HANDLE, HEAD)).total == 1
    assert view_cost([*sizes, HEAD.size], [*positions, HEAD.position], (HANDLE, HEAD)).total == 1
    assert view_cost([], [], (HANDLE, HEAD)).total == 1


def test_a_single_primitive_has_no_relative_place() -> None:
    cost = view_cost([HEAD.size], [(9.0, 9.0, 9.0)], (HEAD,))
    assert (cost.size, cost.spatial) == (0, 0)


edges = st.lists(st.floats(1e-4, 0.5), min_size=3, max_size=3)


@given(edges, edges)
def test_no_other_order_of_edges_fits_better(found: list[float], expected: list[float]) -> None:
    wanted = np.array([expected])
    (difference,) = size_differences(np.array([found]), wanted).ravel()
    orders = [np.abs(np.array(order) - expected).sum() for order in permutations(found)]
    hungarian = np.abs(np.subtract.outer(found, expected))
    assert difference == pytest.approx(min(orders))
    assert difference == pytest.approx(hungarian[linear_sum_assignment(hungarian)].sum())


@given(st.lists(st.tuples(edges, edges), min_size=2, max_size=2))
def test_a_cost_is_between_zero_and_one(found: list[tuple[list[float], list[float]]]) -> None:
    sizes, positions = zip(*found, strict=True)
    assert 0 <= view_cost(sizes, positions, (HANDLE, HEAD)).total <= 1


# What is searched


def test_all_parameters_are_tuned_within_their_limits() -> None:
    assert [tuned.name for tuned in SPACE] == list(EmsParameters.model_fields)
    for end in ("low", "high"):
        ends = {tuned.name: getattr(tuned, end) for tuned in SPACE}
        EmsParameters.model_validate({**ends, "adaptive_upper_bound": end == "high"})


@pytest.mark.parametrize("tuned", SPACE, ids=lambda tuned: tuned.name)
def test_the_published_values_lie_in_the_ranges(tuned: Any) -> None:
    for parameters in PRESETS.values():
        if tuned.low is not None:
            assert tuned.low <= getattr(parameters, tuned.name) <= tuned.high


# How a study goes on


def bowl(parameters: EmsParameters) -> float:
    """A cost with its lowest value inside the ranges."""
    return abs(parameters.outlier_ratio - 0.9) + abs(parameters.min_points - 200) / 500


def searched(folder: Path, steps: int, name: str = "test", seed: int = 0) -> tuple[Trial, ...]:
    with opened(folder, name, seed) as search:
        for _ in range(steps):
            search.step(bowl)
        return search.trials()


def test_a_study_that_was_left_goes_on_as_if_it_had_not_been(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(study, "RANDOM_TRIALS", 3)
    whole = searched(tmp_path / "whole", 6)
    searched(tmp_path / "left", 4)
    with opened(tmp_path / "left", "test", 0) as search:

        def broken(parameters: EmsParameters) -> float:
            raise StageUnavailable("gone")

        with pytest.raises(StageUnavailable):
            search.step(broken)
        search._study.ask()  # as a process that is killed leaves it
    assert searched(tmp_path / "left", 2) == whole
    assert [each.number for each in whole] == list(range(6))
    assert len({each.parameters.model_dump_json() for each in whole}) == 6


def test_studies_do_not_mix(tmp_path: Path) -> None:
    first = searched(tmp_path, 2)
    other = searched(tmp_path, 2, name="other", seed=1)
    assert first[0].parameters != other[0].parameters
    assert searched(tmp_path, 0) == first


def test_two_processes_do_not_search_in_one_folder(tmp_path: Path) -> None:
    with (
        opened(tmp_path, "test", 0),
        pytest.raises(Conflict, match="another process"),
        opened(tmp_path, "test", 0),
    ):
        pass


# Which views


def view_set(counts: dict[str, int], **known: Any) -> ViewSet:
    files = [
        ViewFile(name, number, Path(f"{name}/{number}.npz"))
        for name, count in counts.items()
        for number in range(count)
    ]
    things = {name: Thing("mug" if name == "mug" else "pan") for name in counts}
    return ViewSet("made up", tuple(files), things, is_catalogue=True)


def test_views_to_tune_on_and_others_to_check() -> None:
    first, rest = split(view_set({"a": 10, "b": 3, "c": 1, "mug": 10}))
    assert [(each.object_name, each.number) for each in first] == [
        *(("a", number) for number in range(TUNED_ON)),
        ("b", 0),
        ("b", 1),
        ("c", 0),
    ]
    assert [(each.object_name, each.number) for each in rest] == [
        *(("a", number) for number in range(TUNED_ON, TUNED_ON + CHECKED_ON)),
        ("b", 2),
    ]


def test_views_that_nothing_is_known_about_are_refused() -> None:
    with pytest.raises(InvalidInput, match="views of the catalogue"):
        split(replace(view_set({"a": 2}), is_catalogue=False))
    with pytest.raises(InvalidInput, match="no views of"):
        split(view_set({"mug": 2}))
    with pytest.raises(InvalidInput, match="expected primitives of gadget"):
        tuning_views([ViewFile("gadget", 0, Path("gadget/0.npz"))])


# All of it, on a small slice


@pytest.fixture(scope="module")
def few_views(tmp_path_factory: pytest.TempPathFactory) -> ViewSet:
    folder = tmp_path_factory.mktemp("views") / "set"
    name = next(name for name in CATALOGUE if build(name).class_name in CLASSES)
    make_dataset(folder, DatasetOptions(views=2, objects=(name,)))
    files = view_files(folder / CLEAN)
    return ViewSet("catalogue", files, things_of(folder), is_catalogue=True)


def test_a_small_slice(backend: Client, few_views: ViewSet, tmp_path: Path) -> None:
    asked: list[dict[str, Any]] = []

    def counting(method: str, url: str, **options: Any) -> Any:
        asked.append(options)
        return backend.request(method, url, **options)

    def found(trials: int, folder: str = "tuning", workers: int = 2) -> Any:
        asked.clear()
        console = Console(quiet=True)
        context = Context(
            Sparge(counting), console, tmp_path / folder, (few_views,), workers=workers
        )
        return tuning(trials).run(context)

    findings = found(2)
    headline, parameters, counts, objects = findings.tables
    assert headline.columns[:3] == ("parameters", "cost", "thesis cost")
    assert [row[0] for row in headline.rows[:2]] == list(NAMES.values())
    assert all(0 <= row[1] <= 1 and 0 <= row[6] <= 1 for row in headline.rows)
    assert headline.rows[0][2] == 0.2
    assert [row[0] for row in parameters.rows] == [tuned.thesis_name for tuned in SPACE]
    assert all(sum(row[1:]) == 1 for row in counts.rows)
    assert len(objects.rows) == 1
    assert len(findings.records) == 6
    assert all(png(plot.figure).startswith(b"\x89PNG") for plot in findings.plots)
    assert (tmp_path / "tuning" / "trials.csv").read_text().count("\n") == 3
    # One view: two published sets, two trials, the best again; three sets on the other view.
    assert len(asked) == 8
    assert all(each["params"]["input"] == "object" for each in asked)
    assert len({each["params"]["recovery"] for each in asked}) == 4

    again = found(3)
    assert len(asked) == 7
    assert again.tables[0].rows[:2] == headline.rows[:2]
    assert found(2, folder="elsewhere", workers=1).tables == findings.tables


def test_trials_are_counted_from_one(backend: Client, tmp_path: Path) -> None:
    context = Context(Sparge(backend.request), Console(quiet=True), tmp_path)
    with pytest.raises(InvalidInput, match="trials is 0"):
        run(context, 0)
