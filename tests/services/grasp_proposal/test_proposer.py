"""The stage as a whole: laws that every answer keeps, and what it answers to plain objects."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from services.grasp_proposal.proposer import GraspProposer
from services.grasp_proposal.settings import GraspProposalSettings
from shared.errors import UnknownGripper
from shared.geometry.rotation import matrix_from_quaternion, quaternion_from_matrix
from shared.geometry.se3 import inverse, matrix_from_pose, pose_matrix, transform_points
from shared.grippers import load_grippers
from shared.schemas.grasp import ProposeRequest, ProposeResponse
from shared.schemas.gripper import ParallelGripper
from shared.schemas.route import Nothing
from tests.services.grasp_proposal.scenes import (
    Scene,
    about_z,
    box,
    lying_cylinder,
    rotations_of,
)

Array = NDArray[np.float64]

PROPOSER = GraspProposer(GraspProposalSettings())
PARALLEL = {
    name: gripper
    for name, gripper in load_grippers().items()
    if isinstance(gripper, ParallelGripper)
}
CYLINDER = lying_cylinder()
BAR = box((0.025, 0.15, 0.008))
BOTTLE = box((0.05, 0.06, 0.18), turn=0.2)
WIDE = box((0.10, 0.16, 0.06))


def propose(scene: Scene, **changes: object) -> ProposeResponse:
    return PROPOSER.propose(scene.request(**changes))


def best_score(answer: ProposeResponse) -> float:
    return float(answer.grasps[:, 8].max(initial=0.0))


@pytest.mark.parametrize("scene", [CYLINDER, BAR, BOTTLE], ids=["cylinder", "bar", "bottle"])
@pytest.mark.parametrize("gripper", list(PARALLEL))
def test_no_grasp_touches_anything_on_its_way(scene: Scene, gripper: str) -> None:
    answer = propose(scene, gripper=gripper)
    assert len(answer.grasps) >= 3
    hand = PARALLEL[gripper]
    for row in answer.grasps:
        object_from_hand = matrix_from_pose(row[:3], row[3:7])
        points = transform_points(inverse(object_from_hand), scene.points)
        opening = min(row[7] + 0.01, hand.max_opening)
        tip, back = hand.tip_beyond_tcp, hand.tip_beyond_tcp - hand.finger_length
        in_way = points[(points[:, 2] < tip) & (points[:, 2] > back - 0.10)]
        x, y = np.abs(in_way[:, 0]), np.abs(in_way[:, 1])
        outside = (y > opening / 2 + 5e-4) & (y < opening / 2 + hand.finger_thickness)
        assert not (outside & (x < hand.finger_width / 2)).any()
        before_palm = in_way[in_way[:, 2] < back]
        across = np.abs(before_palm[:, :2]) < np.array(hand.palm_size[:2]) / 2
        assert not across.all(axis=1).any()
        held = (x < hand.finger_width / 2) & (y <= row[7] / 2 + 1e-3)
        assert held.any()
        assert corners_above_table(object_from_hand, hand.palm_size, opening, hand) > 0.0015


def corners_above_table(
    motion: Array, palm: tuple[float, ...], opening: float, hand: ParallelGripper
) -> float:
    tip, back = hand.tip_beyond_tcp, hand.tip_beyond_tcp - hand.finger_length
    side = opening / 2 + hand.finger_thickness
    signs = np.array(np.meshgrid([-1, 1], [-1, 1])).reshape(2, -1).T
    tips = np.column_stack([signs * [hand.finger_width / 2, side], np.full(4, tip)])
    front = np.column_stack([signs * np.array(palm[:2]) / 2, np.full(4, back)])
    return float(transform_points(motion, np.vstack([tips, front]))[:, 2].min())


@pytest.mark.parametrize("scene", [CYLINDER, BAR, BOTTLE], ids=["cylinder", "bar", "bottle"])
def test_rows_are_in_order_and_in_range(scene: Scene) -> None:
    grasps = propose(scene).grasps
    assert (np.diff(grasps[:, 8]) <= 0).all()
    assert ((grasps[:, 8] >= 0) & (grasps[:, 8] <= 1)).all()
    assert ((grasps[:, 7] > 0) & (grasps[:, 7] <= 0.08)).all()
    assert np.linalg.norm(grasps[:, 3:7], axis=1) == pytest.approx(1.0)


def test_a_lying_cylinder_is_held_across_its_axis() -> None:
    best = propose(CYLINDER).grasps[:5]
    axis = about_z(0.5)[:, 1]
    along = np.abs(rotations_of(best)[:, :, 1] @ axis)
    assert along[0] < 0.35
    assert along.max() < 0.5  # 30 degrees off are still held in a friction cone of 0.6
    assert best[:, 7] == pytest.approx(0.04, abs=0.016)  # cut askew, a cylinder is wider
    assert np.linalg.norm(best[:, :2], axis=1).max() < 0.065


def test_a_flat_bar_is_held_from_above_just_over_the_table() -> None:
    best = propose(BAR).grasps[0]
    rotation = matrix_from_quaternion(best[3:7])
    tips = best[2] + rotation[2, 2] * PARALLEL["panda"].tip_beyond_tcp
    assert rotation[2, 2] < -0.7
    assert abs(rotation[:, 1] @ about_z(0.3)[:, 0]) > 0.9
    assert 0.001 < tips < 0.006
    assert best[7] == pytest.approx(0.025, abs=0.006)


def test_what_is_too_wide_gives_no_grasp_worth_trying_and_says_why() -> None:
    cube = np.array([0.1, 0.1, 0.1, 0.1, 0.1, 0, 0, 0.1, *quaternion_from_matrix(about_z(0.3))])
    answer = propose(box((0.2, 0.2, 0.2), step=0.004), superquadrics=cube[None])
    assert best_score(answer) < 0.5
    assert answer.rejected["too_wide"] > 0.5 * answer.considered > 0


def test_nothing_found_is_an_answer() -> None:
    centre = np.abs(WIDE.points[:, :2]).max(axis=1) < 0.01
    answer = propose(WIDE, focus=centre)
    assert answer.grasps.shape == (0, 9)
    assert answer.considered == sum(answer.rejected.values()) > 0


def test_a_wider_gripper_holds_what_another_cannot() -> None:
    assert best_score(propose(WIDE)) < best_score(propose(WIDE, gripper="robotiq_2f140"))


def test_obstacles_are_kept_clear_of() -> None:
    free = propose(CYLINDER)
    axis = about_z(0.5)
    wall = np.array(
        np.meshgrid([-0.035, 0.035], np.arange(-0.1, 0.1, 0.01), np.arange(0, 0.2, 0.01))
    )
    obstacles = wall.reshape(3, -1).T @ axis.T
    walled = propose(CYLINDER, obstacle_points=obstacles)
    assert walled.rejected["collision_obstacle"] > 0
    assert len(walled.grasps) < len(free.grasps)
    for row in walled.grasps:
        local = transform_points(inverse(matrix_from_pose(row[:3], row[3:7])), obstacles)
        near = (np.abs(local[:, 0]) < 0.011) & (local[:, 2] < 0.008) & (local[:, 2] > -0.14)
        assert not (near & (np.abs(local[:, 1]) < row[7] / 2 + 0.005)).any()


def test_grasps_are_where_the_focus_is() -> None:
    along = CYLINDER.points @ about_z(0.5)[:, 1]
    best = propose(CYLINDER, focus=along > 0.03).grasps[:5]
    assert (best[:, :3] @ about_z(0.5)[:, 1]).min() > 0.02


def test_says_how_much_of_what_is_held_is_in_the_focus() -> None:
    along = CYLINDER.points @ about_z(0.5)[:, 1]
    whole, half = propose(CYLINDER), propose(CYLINDER, focus=along > 0.0)
    assert (whole.on_focus == 1.0).all()
    assert half.on_focus.shape == (len(half.grasps), 3)
    assert ((half.on_focus >= 0) & (half.on_focus <= 1)).all()
    place = half.grasps[:, :3] @ about_z(0.5)[:, 1]
    assert (half.on_focus[place > 0.02] > 0.95).all()
    at_the_border = half.on_focus[np.abs(place) < 0.004]
    assert ((at_the_border > 0.05) & (at_the_border < 0.95)).all(axis=1).any()


def test_says_which_hands_keep_away_from_the_rest() -> None:
    along = CYLINDER.points @ about_z(0.5)[:, 1]
    assert propose(CYLINDER).keeps_clear.all()
    focus = along > -0.02
    answer = propose(CYLINDER, focus=focus)
    assert 0 < answer.keeps_clear.sum() < len(answer.grasps)
    hand = PARALLEL["panda"]
    rest = CYLINDER.points[along < -0.02 - hand.finger_width - 0.002]
    for row, clear in zip(answer.grasps, answer.keeps_clear, strict=True):
        local = transform_points(inverse(matrix_from_pose(row[:3], row[3:7])), rest)
        x, y, z = np.abs(local[:, 0]), np.abs(local[:, 1]), local[:, 2]
        front = hand.tip_beyond_tcp - hand.finger_length
        between = (x < hand.finger_width / 2) & (y < row[7] / 2) & (z < hand.tip_beyond_tcp)
        palm = (x < hand.palm_size[0] / 2) & (y < hand.palm_size[1] / 2) & (z < front + 0.009)
        assert not (clear and (between | palm).any())
    nearly_all = along > along.min() + 0.9 * hand.finger_width  # the rest is beside the focus
    assert propose(CYLINDER, focus=nearly_all).keeps_clear.all()
    far = answer.grasps[:, :3] @ about_z(0.5)[:, 1] > 0.06
    assert answer.keeps_clear[far].mean() > answer.keeps_clear[~far].mean()


def test_no_two_grasps_are_alike() -> None:
    grasps = propose(CYLINDER).grasps
    turns = rotations_of(grasps)
    for i in range(len(grasps)):
        near = np.linalg.norm(grasps[:i, :3] - grasps[i, :3], axis=1) < 0.0099
        approach = turns[:i, :, 2] @ turns[i, :, 2] > np.cos(np.radians(19.9))
        closing = np.abs(turns[:i, :, 1] @ turns[i, :, 1]) > np.cos(np.radians(19.9))
        assert not (near & approach & closing).any()


def test_the_same_request_gives_the_same_bytes_in_any_order_of_points() -> None:
    first = propose(BOTTLE, seed=5)
    order = np.random.default_rng(0).permutation(len(BOTTLE.points))
    again = propose(BOTTLE, seed=5, points=BOTTLE.points[order])
    assert again.grasps.tobytes() == first.grasps.tobytes()
    assert again.rejected == first.rejected


def test_the_seed_chooses_the_samples() -> None:
    one, two = (propose(BOTTLE, seed=seed, samples=20).grasps for seed in (0, 1))
    assert one.shape != two.shape or not np.array_equal(one, two)


def test_a_moved_scene_gives_the_moved_grasps() -> None:
    motion = pose_matrix([0.7, -0.3, 1.1], about_z(0.9)[[1, 2, 0]] @ about_z(2.0))
    noise = np.random.default_rng(0).normal(scale=2e-4, size=BOTTLE.points.shape)
    scene = Scene(BOTTLE.points + noise, BOTTLE.normals, BOTTLE.sensor, BOTTLE.up)
    here, there = propose(scene).grasps, propose(scene.moved(motion)).grasps
    assert len(here) == len(there)
    turned = motion[:3, :3] @ rotations_of(here)
    same = np.abs(there[:, 8] - here[:, 8]) < 1e-4
    same &= np.linalg.norm(there[:, :3] - transform_points(motion, here[:, :3]), axis=1) < 1e-4
    same &= np.abs(rotations_of(there) - turned).max(axis=(1, 2)) < 1e-3
    assert same.mean() > 0.9


def test_every_pose_has_one_fate() -> None:
    answer = propose(CYLINDER)
    assert answer.considered == len(answer.grasps) + sum(answer.rejected.values())
    assert min(answer.rejected.values()) > 0


@pytest.mark.parametrize(
    "changes",
    [
        {"plane": None},
        {"plane": None, "up": None},
        {"viewpoint": (0.0, 0.0, 0.02)},
        {"plane": None, "up": None, "viewpoint": (0.0, 0.0, 0.02)},
        {"viewpoint": (0.0, 0.0, 2.0)},
        {"samples": 1},
        {"samples": 5000},
        {"obstacle_points": np.empty((0, 3))},
    ],
)
def test_what_is_not_known_is_done_without(changes: dict[str, object]) -> None:
    answer = propose(CYLINDER, **changes)
    assert np.isfinite(answer.grasps).all()
    assert len(answer.grasps) or changes == {"samples": 1}


LINE = np.column_stack([np.linspace(0, 0.1, 30), np.zeros(30), np.full(30, 0.05)])


@pytest.mark.parametrize(
    "points",
    [
        np.tile([0.1, 0.2, 0.05], (15, 1)),
        LINE,
        np.random.default_rng(0).uniform(0, 0.1, (300, 3)) * [1, 1, 0],
        np.random.default_rng(0).uniform(0, 1e-7, (300, 3)),
        np.random.default_rng(0).uniform(-900, 900, (30_000, 3)),
        np.random.default_rng(0).uniform(-0.05, 0.05, (10, 3)),
        np.vstack([LINE, LINE, LINE + 5000.0]),
        np.random.default_rng(0).uniform(0, 0.05, (500, 3)) - [0, 0, 3],
    ],
    ids=["spot", "line", "plane", "dust", "huge", "few", "duplicates_far", "under_the_table"],
)
@pytest.mark.parametrize("with_plane", [True, False])
def test_odd_clouds_give_finite_answers(points: Array, with_plane: bool) -> None:
    request = CYLINDER.request(points=points, samples=40)
    if not with_plane:
        request = ProposeRequest(points=points, samples=40, obstacle_points=points[:5])
    answer = PROPOSER.propose(request)
    assert np.isfinite(answer.grasps).all()
    assert answer.considered >= len(answer.grasps)


def test_unknown_gripper() -> None:
    with pytest.raises(UnknownGripper, match="panda"):
        propose(CYLINDER, gripper="claw")


def test_lists_the_grippers() -> None:
    listed = PROPOSER.list_grippers(Nothing()).grippers
    assert [gripper.name for gripper in listed] == list(load_grippers())
