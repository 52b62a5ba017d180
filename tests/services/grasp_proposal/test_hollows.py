from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from services.grasp_proposal.hollows import hidden_floor
from services.grasp_proposal.proposer import GraspProposer
from services.grasp_proposal.settings import GraspProposalSettings
from tests.services.grasp_proposal.scenes import (
    PAN,
    SENSOR,
    UP,
    Scene,
    behind_the_wall,
    box,
    pan,
    rotations_of,
)

TIP_BEYOND_TCP, ON_THE_FINGER = 0.008, 0.009
"""Of the Panda's fingers, metres: their tips, and how far from the part a point of one is."""


def out_of_sight() -> np.ndarray:
    """Return points (N, 3) of the pan's floor that its near wall hides."""
    x, y = (axis.ravel() for axis in np.meshgrid(*[np.arange(-0.1, 0.1, 0.004)] * 2))
    floor = np.column_stack([x, y, np.full_like(x, PAN["floor"])])
    within = np.hypot(x, y) < PAN["radius"] - 0.004
    return np.asarray(floor[within & behind_the_wall(floor)])


def test_a_floor_goes_on_to_the_wall_that_hides_it() -> None:
    scene, hidden = pan(0.003), out_of_sight()
    found = hidden_floor(scene.points, scene.normals, UP, SENSOR)
    assert len(hidden) > 50
    assert found[:, 2] == pytest.approx(PAN["floor"])
    assert np.hypot(found[:, 0], found[:, 1]).max() < PAN["radius"] + PAN["wall"] + 0.004
    distance = np.asarray(cKDTree(found).query(hidden)[0])
    assert np.mean(distance < 0.006) > 0.95


def test_it_moves_with_the_scene() -> None:
    scene = pan(0.003)
    turned = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    here = hidden_floor(scene.points, scene.normals, UP, SENSOR)
    moved = hidden_floor(
        scene.points @ turned.T + 1.0, scene.normals @ turned.T, UP, turned @ SENSOR + 1.0
    )
    assert np.allclose(here @ turned.T + 1.0, moved, atol=1e-9)


def two_boxes(apart: float) -> Scene:
    """Return a high box and, `apart` behind it, a low one."""
    high, low = box((0.06, 0.06, 0.06), 0.0, 0.003), box((0.06, 0.06, 0.02), 0.0, 0.003)
    away = np.array([0.06 + apart, 0.0, 0.0])
    return Scene(
        np.vstack([high.points, low.points + away]),
        np.vstack([high.normals, low.normals]),
        SENSOR,
        UP,
    )


def test_nothing_is_known_where_the_table_is_seen_behind_an_edge() -> None:
    scene = two_boxes(apart=0.12)
    assert not len(hidden_floor(scene.points, scene.normals, UP, SENSOR))


def test_no_surface_is_taken_to_go_on_that_is_not_level_lower_and_hidden() -> None:
    solid = box((0.1, 0.1, 0.1), 0.3, 0.003)
    assert not len(hidden_floor(solid.points, solid.normals, UP, SENSOR))


@pytest.mark.parametrize(("away", "goes_on"), [(0.3, True), (3.0, False), (5e3, False)])
def test_no_floor_goes_on_for_longer_than_a_hand_reaches(away: float, goes_on: bool) -> None:
    edge = np.array([0.0, 0.0, 0.06])
    sight = (edge - SENSOR) / (edge - SENSOR)[0]
    points = np.array([edge, edge + away * sight + [0.0, 0.0, 0.001]])
    assert bool(len(hidden_floor(points, np.tile(UP, (2, 1)), UP, SENSOR))) == goes_on


@pytest.mark.parametrize(
    ("up", "viewpoint"), [(None, SENSOR), (UP, None), (UP, np.array([0.0, 0.0, 0.8]))]
)
def test_without_up_or_a_sensor_at_the_side_there_is_none(
    up: np.ndarray | None, viewpoint: np.ndarray | None
) -> None:
    scene = pan(0.003)
    assert hidden_floor(scene.points, scene.normals, up, viewpoint).shape == (0, 3)


def test_no_finger_is_sent_into_a_floor_behind_the_wall() -> None:
    scene = pan()
    near_rim = (scene.points[:, 0] < -0.06) & (scene.points[:, 2] > PAN["height"] - 0.02)
    answer = GraspProposer(GraspProposalSettings()).propose(scene.request(focus=near_rim))
    grasps, rotations = answer.grasps, rotations_of(answer.grasps)
    ahead = grasps[:, :3] + TIP_BEYOND_TCP * rotations[:, :, 2]
    aside = (grasps[:, 7, None] / 2 + ON_THE_FINGER) * rotations[:, :, 1]
    tips = [ahead - aside, ahead + aside]
    inside = [tip[np.hypot(tip[:, 0], tip[:, 1]) < PAN["radius"] - 0.004] for tip in tips]
    lowest = np.concatenate(inside)[:, 2]
    assert len(lowest) > 3
    assert lowest.min() > PAN["floor"]
