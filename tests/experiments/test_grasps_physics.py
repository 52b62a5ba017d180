"""What physics says about grasps, and what the tables make of it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial import cKDTree

from experiments.catalogue import build
from experiments.framework import Asked, Share
from experiments.framework.replay import Replays, free_hand
from experiments.framework.views import load
from experiments.grasps.experiment import run
from experiments.grasps.judged import Judged, judge, shares
from experiments.grasps.physics_tables import outcomes_table, physics_by_class, physics_table
from experiments.grasps.sheet import failed, failure_sheet, hand_lines
from shared.client import Sparge
from shared.geometry.se3 import matrix_from_pose, transform_points
from shared.grippers import load_grippers
from shared.schemas.gripper import ParallelGripper
from tests.experiments.conftest import MakeContext

ASKED = Asked("views", "bottle1", "bottle", "0", "pouring", "v2", afforded=True, grasped=True)
GRASP = np.array([0.0, 0.0, 0.7, 1.0, 0.0, 0.0, 0.0, 0.05, 0.9])


def hand() -> ParallelGripper:
    panda = load_grippers()["panda"]
    assert isinstance(panda, ParallelGripper)
    return panda


def trial(outcome: str | None, *, right: bool = True, **changes: Any) -> Judged:
    asked = replace(ASKED, grasp_in_region=right, **changes)
    return Judged(asked, None if outcome == "no_grasp" else GRASP, outcome)


def test_what_counts_as_lifted_and_as_held() -> None:
    outcomes = ["held", "slipped_in_shake", "lifted", "slipped_in_lift", "pushed_away", "no_grasp"]
    trials = [trial(outcome) for outcome in outcomes]
    assert [each.lifted for each in trials] == [True, True, True, False, False, False]
    assert [each.held for each in trials] == [True] + 5 * [False]


def test_shares_count_no_grasp_and_leave_out_what_was_not_tried() -> None:
    trials = [trial("held"), trial("held", right=False), trial("no_grasp"), trial(None)]
    right, lifted, held, both = shares(trials)
    assert right == Share(2, 3)
    assert lifted == held == Share(2, 3)
    assert both == Share(1, 3)


def test_tables_by_method_class_and_outcome() -> None:
    trials = [
        trial("held"),
        trial("slipped_in_lift"),
        trial("slipped_in_shake", reasoning="blind"),
        trial("held", class_name="pan", task="cooking", thing="pan1"),
    ]
    lines = {row[1]: row for row in physics_table(trials).rows}
    assert lines["Version 2"][2] == 3
    assert lines["Version 2"][5] == Share(2, 3)
    assert lines["task-blind"][4:6] == (Share(1, 1), Share(0, 1))
    assert {row[1:4] for row in physics_by_class(trials).rows} == {
        ("bottle", "pouring", 2),
        ("pan", "cooking", 1),
    }
    table = outcomes_table(trials)
    counts = {row[1]: dict(zip(table.columns[2:], row[2:], strict=True)) for row in table.rows}
    assert counts["Version 2"] == {"held": 2, "slipped in lift": 1, "slipped in shake": 0}


def test_the_sheet_shows_every_kind_of_failure_before_one_twice() -> None:
    trials = [trial("slipped_in_lift", view=str(n)) for n in range(5)]
    trials += [trial("no_grasp", thing="pan1"), trial("held"), trial("missed", reasoning="v1")]
    chosen = failed(trials, count=3)
    assert [each.outcome for each in chosen] == ["slipped_in_lift", "no_grasp", "slipped_in_lift"]


def test_the_drawn_hand_is_as_wide_as_the_grasp_and_comes_along_its_approach() -> None:
    outline, approach = hand_lines(GRASP, hand())
    assert np.ptp(outline, axis=0)[1] == pytest.approx(GRASP[7])
    direction = approach[1] - approach[0]
    np.testing.assert_allclose(direction / np.linalg.norm(direction), [0, 0, -1], atol=1e-9)


def test_a_grasp_is_replayed_where_the_object_was_seen(make_context: MakeContext) -> None:
    context = make_context("bottle1")
    (views,) = context.sets
    view, thing = load(views.files[0]), build("bottle1")
    request = free_hand(view, thing.surface.vertices, thing.surface.faces, GRASP)
    assert request.vertices is not None
    assert request.faces is not None
    assert request.object_pose is not None
    placed = matrix_from_pose(request.object_pose.position, request.object_pose.quaternion)
    vertices = transform_points(placed, request.vertices)
    surface = np.vstack([vertices, vertices[request.faces].mean(axis=1)])
    distance = cKDTree(surface).query(view.object_points)[0]
    assert np.median(distance) < 0.01
    assert request.strict
    assert request.actor == "hand"
    assert request.heading is not None
    towards = view.object_points.mean(axis=0)
    assert towards @ np.array(request.heading) > 0.9 * np.linalg.norm(towards)


def test_physics_of_one_view(make_context: MakeContext, sparge: Sparge) -> None:
    context = make_context("hammer1")
    shown = replace(context.sets[0], objects={"hammer1": build("hammer1")})
    findings = run(replace(context, sets=(shown,)))
    physics = next(table for table in findings.tables if table.name == "grasps-physics")
    assert [row[2] for row in physics.rows] == [2, 2, 2]
    assert all(record["outcome"] for record in findings.records)
    lifted = [record["lifted"] for record in findings.records]
    assert lifted.count("true") >= 4, findings.records  # a hammer is easy to hold
    trials = [
        judge(Replays(sparge), load(shown.files[0]), build("hammer1"), ASKED, None),
        trial("slipped_in_lift", source=shown.name, thing="hammer1", task="hammering"),
    ]
    assert trials[0].outcome == "no_grasp"
    sheet = failure_sheet((shown,), failed(trials)[1:], hand())
    assert sheet.name == "failed-grasps"
