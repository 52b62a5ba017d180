"""Suction: where the lip seals, what the cup may touch, and the laws of the answer."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from services.grasp_proposal.cup import Cup
from services.grasp_proposal.proposer import GraspProposer
from services.grasp_proposal.rejections import Rejections
from services.grasp_proposal.seal import LIP, SECTORS, seal
from services.grasp_proposal.settings import GraspProposalSettings
from services.grasp_proposal.suction import propose_suction
from services.grasp_proposal.workspace import build_workspace
from shared.geometry.se3 import inverse, matrix_from_pose, pose_matrix, transform_points
from shared.grippers import load_grippers
from shared.schemas.grasp import ProposeResponse
from shared.schemas.gripper import SuctionGripper
from tests.services.grasp_proposal.scenes import Scene, about_z, box, lying_cylinder, rotations_of

Array = NDArray[np.float64]

SETTINGS = GraspProposalSettings()
PROPOSER = GraspProposer(SETTINGS)


def shipped_cup() -> SuctionGripper:
    gripper = load_grippers()["onrobot_vgc10"]
    assert isinstance(gripper, SuctionGripper)
    return gripper


VGC10 = shipped_cup()
RADIUS = VGC10.cup_diameter / 2
SIZE = (0.10, 0.16, 0.06)
BOX = box(SIZE, turn=0.3)
INWARDS = np.diag([1.0, -1.0, -1.0])


def propose(scene: Scene, **changes: object) -> ProposeResponse:
    return PROPOSER.propose(scene.request(**({"gripper": "onrobot_vgc10"} | changes)))


def sphere(radius: float) -> Array:
    """Return points of the cap of a sphere whose top is the origin."""
    x, y = np.meshgrid(*(np.arange(-0.03, 0.0301, 0.001),) * 2)
    z = np.sqrt(radius**2 - x**2 - y**2) - radius
    return np.column_stack([x.ravel(), y.ravel(), z.ravel()])


def set_down(points: Array, radius: float = 0.02):  # type: ignore[no-untyped-def]
    """Set one cup down at the origin, from above."""
    focus = np.ones(len(points), dtype=np.bool_)
    return seal(points, focus, np.zeros((1, 3)), INWARDS[None], radius, 0.01)


def test_a_lip_on_a_plane_has_no_gap() -> None:
    plane = sphere(1.0) * [1, 1, 0]
    found = set_down(plane)
    assert found.covered[0] == SECTORS
    assert found.gap[0] == found.bump[0] == 0.0
    assert found.in_focus[0] == 1.0


def test_a_lip_beyond_an_edge_is_not_covered() -> None:
    plane = sphere(1.0) * [1, 1, 0]
    assert set_down(plane[plane[:, 0] < 0.010]).covered[0] < SECTORS
    step = plane - [0, 0, 0.02] * (plane[:, :1] >= 0.010)
    assert set_down(step).covered[0] < SECTORS


def test_the_gap_of_a_cylinder_is_its_sagitta() -> None:
    x, y = np.meshgrid(*(np.arange(-0.03, 0.0301, 0.0005),) * 2)
    radius = 0.04
    points = np.column_stack([x.ravel(), y.ravel(), (np.sqrt(radius**2 - x**2) - radius).ravel()])
    found = set_down(points)
    assert found.gap[0] == pytest.approx(0.02**2 / (2 * radius), rel=0.3)


def test_a_sphere_stands_up_inside_the_lip() -> None:
    found = set_down(sphere(0.05))
    lip = np.array([1 - LIP, 1.0]) * 0.02
    low, high = lip**2 / (2 * 0.05)
    assert low < found.bump[0] < 1.2 * high
    assert found.gap[0] < 0.001


def test_the_lip_of_every_grasp_lies_on_one_face_of_the_box() -> None:
    answer = propose(BOX)
    assert len(answer.grasps) >= 5
    assert (answer.grasps[:, 7] == 0).all()
    turned = about_z(0.3).T
    for place, turn in zip(answer.grasps[:, :3], rotations_of(answer.grasps), strict=True):
        local = turned @ (place - [0, 0, SIZE[2] / 2])
        approach = turned @ turn[:, 2]
        face = int(np.abs(approach).argmax())
        assert abs(approach[face]) > 0.97
        assert local[face] == pytest.approx(-np.sign(approach[face]) * SIZE[face] / 2, abs=0.002)
        for axis in {0, 1, 2} - {face}:
            assert abs(local[axis]) < SIZE[axis] / 2 - (1 - LIP) * RADIUS


def test_rows_are_in_order_in_range_and_unlike() -> None:
    answer = propose(BOX)
    scores, centres = answer.grasps[:, 8], answer.grasps[:, :3]
    assert (np.diff(scores) <= 0).all()
    assert ((scores > 0) & (scores <= 1)).all()
    away = np.linalg.norm(centres[:, None] - centres, axis=2)
    alike = np.einsum("gi,hi->gh", *[rotations_of(answer.grasps)[:, :, 2]] * 2) > 0.95
    assert not (np.triu(away < 0.0099, 1) & alike).any()


def test_the_best_place_is_near_the_centre_of_mass() -> None:
    best = propose(BOX).grasps[0]
    assert np.linalg.norm(best[:2]) < 0.04


@pytest.mark.parametrize("radius", [0.012, 0.02])
def test_a_bar_that_is_too_round_gives_no_grasp_and_says_why(radius: float) -> None:
    answer = propose(lying_cylinder(radius))
    assert answer.grasps.shape == (0, 9)
    assert set(answer.rejected) == {"no_seal"}


def test_every_place_has_one_fate() -> None:
    obstacles = BOX.points + np.array([0.0, 0.0, 0.10])
    answer = propose(BOX, obstacle_points=obstacles, samples=300)
    assert answer.considered == 300 == len(answer.grasps) + sum(answer.rejected.values())
    assert answer.rejected["collision_obstacle"] > 0
    assert len(answer.grasps) < len(propose(BOX, samples=300).grasps)


def test_the_palm_stays_off_the_table() -> None:
    answer = propose(box((0.06, 0.16, 0.045)))
    for row in answer.grasps:
        motion = matrix_from_pose(row[:3], row[3:7])
        signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 0])).reshape(3, -1).T
        corners = signs * np.array(VGC10.palm_size) / [2, 2, 1] - [0, 0, VGC10.cup_length]
        assert transform_points(motion, corners)[:, 2].min() > 0.002
    assert answer.rejected["collision_support"] > 0


def test_too_heavy_for_a_weak_cup() -> None:
    workspace = build_workspace(BOX.request())
    rejected = Rejections()
    weak = Cup.of(VGC10.model_copy(update={"force": 0.5}), SETTINGS)
    found = propose_suction(workspace, weak, 100, np.random.default_rng(0), rejected, 10)
    assert len(found.scores) == 0
    assert rejected.counts["too_heavy"] > 10


def test_grasps_are_where_the_focus_is() -> None:
    right = BOX.points @ about_z(0.3)[:, 1] > 0.0
    answer = propose(BOX, focus=right)
    assert (answer.grasps[:, :3] @ about_z(0.3)[:, 1] > -0.002).all()
    assert answer.on_focus.shape == (len(answer.grasps), 3)
    assert answer.on_focus[0].min() > 0.8


def test_the_same_request_gives_the_same_bytes_in_any_order_of_points() -> None:
    first = propose(BOX, seed=5)
    order = np.random.default_rng(0).permutation(len(BOX.points))
    again = propose(BOX, seed=5, points=BOX.points[order])
    assert again.grasps.tobytes() == first.grasps.tobytes()
    assert again.rejected == first.rejected


def test_a_moved_scene_gives_the_moved_grasps() -> None:
    motion = pose_matrix([0.7, -0.3, 1.1], about_z(0.9)[[1, 2, 0]] @ about_z(2.0))
    noise = np.random.default_rng(0).normal(scale=2e-4, size=BOX.points.shape)
    scene = Scene(BOX.points + noise, BOX.normals, BOX.sensor, BOX.up)
    here, there = propose(scene).grasps, propose(scene.moved(motion)).grasps
    assert len(here) == len(there) > 0
    back = transform_points(inverse(motion), there[:, :3])
    near = np.linalg.norm(back - here[:, :3], axis=1) < 1e-4
    turned = motion[:3, :3] @ rotations_of(here)
    near &= np.abs(rotations_of(there) - turned).max(axis=(1, 2)) < 1e-3
    assert near.mean() > 0.9


@pytest.mark.parametrize("changes", [{"plane": None}, {"plane": None, "up": None}, {"samples": 1}])
def test_what_is_not_known_is_done_without(changes: dict[str, object]) -> None:
    answer = propose(BOX, **changes)
    assert np.isfinite(answer.grasps).all()
    assert answer.considered == len(answer.grasps) + sum(answer.rejected.values())
