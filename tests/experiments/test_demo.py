"""Experiment 5: scenes that are what they claim, one real trial, and what is made of trials."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageSequence
from scipy.spatial import cKDTree

from experiments.catalogue import build
from experiments.demo.experiment import BOTTLE, FILM, TASKS, findings
from experiments.demo.films import FRAME_MS, LAST_FRAME_MS, frames, side_by_side
from experiments.demo.scenes import POSES, Scene, make_scene
from experiments.demo.tables import one_by_one, summary
from experiments.demo.trials import Trial, attempt, execution
from experiments.framework.replay import Replays
from experiments.framework.scoring import RegionScore
from shared.client import Sparge
from shared.schemas.execution import ExecuteResponse, Outcome, Phase

VIEWS = 5


def scene(pose: str, number: int = 0, seed: int = 0) -> Scene:
    return make_scene(build(BOTTLE), pose, number, VIEWS, seed)


@pytest.mark.parametrize("pose", POSES)
def test_the_mesh_is_where_the_camera_sees_the_object_and_stands_on_the_table(pose: str) -> None:
    held = scene(pose)
    surface = held.thing.surface
    inside = held.vertices[surface.faces].mean(axis=1)
    distance = cKDTree(np.vstack([held.vertices, inside])).query(held.shown.object_points)[0]
    assert np.median(distance) < 0.005
    heights = held.vertices @ np.array(held.up)
    table = held.shown.points[held.shown.view.label.ravel() == 1] @ np.array(held.up)
    assert heights.min() == pytest.approx(np.median(table), abs=0.002)


def test_flat_lies_and_upright_stands() -> None:
    tall = {pose: np.ptp(scene(pose).vertices @ np.array(scene(pose).up)) for pose in POSES}
    assert tall["flat"] < 0.09 < 0.2 < tall["upright"]


def test_a_scene_is_made_again_and_another_seed_makes_another() -> None:
    one, again, other = scene("flat", 2), scene("flat", 2), scene("flat", 2, seed=1)
    np.testing.assert_array_equal(one.shown.view.depth, again.shown.view.depth)
    np.testing.assert_array_equal(one.vertices, again.vertices)
    assert not np.array_equal(one.vertices, other.vertices)


def test_views_go_all_round() -> None:
    yaw = np.sort([scene("flat", number).yaw_deg for number in range(VIEWS)])
    assert np.diff(np.append(yaw, yaw[0] + 360)).max() < 360 / VIEWS + 2 * 25 + 1


def test_the_part_to_hold_is_highlighted() -> None:
    held = scene("upright")
    chosen = {task: held.faces_of(task) for task in TASKS}
    for task in TASKS:
        asked = execution(held, task, np.array([0, 0, 0.7, 0, 0, 0, 1, 0.03, 0.5]))
        assert asked.animate
        np.testing.assert_array_equal(asked.highlight, chosen[task])
    corners = held.thing.surface.vertices[held.thing.surface.faces].mean(axis=1)[:, 2]
    assert corners[chosen["handover"]].min() > corners[chosen["pouring"]].mean()
    assert not (chosen["handover"] & chosen["pouring"]).any()


def test_a_slice_of_the_experiment(sparge: Sparge, tmp_path: Path) -> None:
    real = attempt(sparge, Replays(sparge), scene("upright"), "handover", "v1")
    trials = [real, trial("flat", outcome=None)]
    found = findings(trials, tmp_path)
    headline, every = found.tables
    assert len(headline.rows) == len(every.rows) == len(found.records) == 2
    films = {path.stem for path in tmp_path.glob("*.gif")} - {Path(FILM).stem}
    assert films == {each.name for each in trials if each.film}
    assert (real.executed is not None) == (real.tried > 0)
    if real.executed is None:
        assert real.outcome.startswith("no ")
    if real.lifted:
        assert real.film.startswith(b"GIF89a")
        assert real.executed is not None
        assert real.executed.lift_height > 0.05


def trial(pose: str = "flat", outcome: Outcome | None = "lifted", film: bytes = b"") -> Trial:
    executed = None
    if outcome is not None:
        phases = tuple(
            Phase(name=name, simulated_s=0.5 + k)
            for k, name in enumerate(("settle", "drive", "approach", "close", "lift", "hold"))
        )
        executed = ExecuteResponse(
            success=outcome == "lifted",
            lifted=outcome == "lifted",
            outcome=outcome,
            message="",
            lift_height=0.3 if outcome == "lifted" else -0.05,
            phases=phases,
        )
    return Trial(
        pose,
        "handover",
        "v2",
        0,
        0.0,
        found=outcome is not None,
        reason="" if outcome else "no_part_matches",
        score=RegionScore(0.9, 0.9, 0.9, 0.8) if outcome else None,
        tried=int(outcome is not None),
        in_region=outcome is not None,
        executed=executed,
        film=film,
    )


def test_what_was_not_found_counts() -> None:
    trials = [trial(), trial(outcome="slipped_in_lift"), trial(outcome=None)]
    (row,) = summary(trials).texts()
    named = dict(zip(summary(trials).columns, row, strict=True))
    assert named["found"].startswith("2/3")
    assert named["lifted"].startswith("1/3")
    assert named["lift height (mm)"].startswith("300")
    assert [row[-2] for row in one_by_one(trials).texts()] == [
        "lifted",
        "slipped in lift",
        "no region: no part matches",
    ]


def test_lifted_by_the_wrong_part_is_no_success() -> None:
    assert trial().succeeded
    assert not replace(trial(), in_region=False).succeeded
    assert not trial(outcome="slipped_in_lift").succeeded


def moving_square(count: int, colour: tuple[int, int, int]) -> bytes:
    pictures = []
    for k in range(count):
        picture = Image.new("RGB", (40, 30), "white")
        picture.paste(colour, (k, 10, k + 6, 16))
        pictures.append(picture)
    stream = io.BytesIO()
    pictures[0].save(
        stream,
        format="GIF",
        save_all=True,
        append_images=pictures[1:],
        duration=[FRAME_MS] * (count - 1) + [LAST_FRAME_MS],
        loop=0,
    )
    return stream.getvalue()


def test_films_side_by_side_last_as_long_as_the_longest() -> None:
    short, long = moving_square(8, (200, 0, 0)), moving_square(20, (0, 0, 200))
    assert (len(frames(short)), len(frames(long))) == (8, 20)
    both = side_by_side([trial("flat", film=short), trial("upright", film=long)])
    with Image.open(io.BytesIO(both)) as held:
        shown = [(each.size, each.info["duration"]) for each in ImageSequence.Iterator(held)]
    assert {size[0] for size, _ in shown} == {80}
    assert sum(lasts for _, lasts in shown) == 19 * FRAME_MS + LAST_FRAME_MS


def test_stills_of_what_was_filmed(tmp_path: Path) -> None:
    film = moving_square(55, (200, 0, 0))
    found = findings([trial(film=film), trial("upright", outcome=None)], tmp_path)
    assert len(found.plots) == 1
    assert (tmp_path / "flat-handover-v2-0.gif").read_bytes() == film
    again = findings([trial("upright", outcome=None)], tmp_path)
    assert again.plots == ()
    assert list(tmp_path.glob("*.gif")) == []
