"""Meshes and stages against what they stand for."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from services.viewer.drawing import Stage, gripper_mesh
from services.viewer.drawing.answer import score_colour, wxyz
from services.viewer.drawing.gripper import fork_mesh
from shared.geometry.se3 import transform_points
from shared.grippers.library import load_grippers
from shared.schemas.gripper import ParallelGripper, SuctionGripper

GRIPPERS = load_grippers()


@pytest.mark.parametrize("name", sorted(GRIPPERS))
def test_a_gripper_is_as_large_as_its_data_say(name: str) -> None:
    gripper = GRIPPERS[name]
    width = 0.8 * gripper.max_opening if isinstance(gripper, ParallelGripper) else 0.0
    vertices, faces = gripper_mesh(gripper, width)
    solid = trimesh.Trimesh(vertices, faces)
    low, high = solid.bounds
    if isinstance(gripper, ParallelGripper):
        assert solid.is_watertight
        assert solid.volume > 0, "triangles face outwards"
        assert high[2] == pytest.approx(gripper.tip_beyond_tcp)
        span = max(width + 2 * gripper.finger_thickness, gripper.palm_size[1])
        assert high[1] - low[1] == pytest.approx(span)
        fingers = vertices[vertices[:, 2] > gripper.tip_beyond_tcp - 1e-9]
        assert np.abs(fingers[:, 1]).min() == pytest.approx(width / 2), "the opening is free"
    else:
        assert isinstance(gripper, SuctionGripper)
        assert high[2] == pytest.approx(0)
        assert high[0] - low[0] >= gripper.cup_diameter * 0.99


def test_a_hint_of_a_gripper_closes_where_the_gripper_does() -> None:
    gripper = GRIPPERS["panda"]
    vertices, _ = fork_mesh(gripper, 0.04)
    inner = np.abs(vertices[vertices[:, 2] > 0][:, 1]).min()
    assert inner == pytest.approx(0.02)


def test_the_world_stands_upright_under_the_object(rng: np.random.Generator) -> None:
    up = np.array([0.1, -0.9, -0.3])
    up /= np.linalg.norm(up)
    points = rng.normal((0.1, 0.0, 0.8), (0.1, 0.02, 0.02), size=(500, 3))
    points[::50] = np.nan
    stage = Stage.of(points, up, (0.0, 0.0, 0.0))
    world = transform_points(stage.world_from_view, points[np.isfinite(points).all(axis=1)])
    np.testing.assert_allclose(stage.world_from_view[:3, :3] @ up, [0, 0, 1], atol=1e-9)
    assert world[:, 2].min() == pytest.approx(0)
    sensor = stage.world_from_view[:3, 3]
    assert sensor[0] < 0, "away from the sensor is +x"
    assert abs(sensor[1]) < 0.25 * abs(sensor[0])
    assert stage.eye[2] > world[:, 2].max()
    towards = (stage.eye - stage.look_at)[:2]
    assert towards @ sensor[:2] > 0, "seen from the sensor's side"


def test_a_stage_without_points_is_a_stage() -> None:
    stage = Stage.of(np.empty((0, 3)), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert np.isfinite(stage.world_from_view).all()
    assert np.linalg.norm(stage.eye - stage.look_at) > 0.05


def test_colours_and_orders() -> None:
    red, green = score_colour(0.0), score_colour(1.0)
    assert red[0] > red[1]
    assert green[1] > green[0]
    assert wxyz(np.array([0.1, 0.2, 0.3, 0.9])) == (0.9, 0.1, 0.2, 0.3)
