"""Which plane is the table, when there are others."""

from __future__ import annotations

import numpy as np
import pytest

from services.perception.perceive import Perception
from shared.errors import NoObject
from shared.schemas.scene import PerceiveRequest
from tests.services.perception.scenes import Shot, Stage, head_camera, spoon


@pytest.fixture(scope="module")
def stage() -> Perception:
    return Perception()


def room() -> Stage:
    """A table before a wall, on a floor that is seen beyond its edges."""
    floor = Stage().table(1.2, 0.7).box("floor", (6, 6, 0.01), (1, 0, -0.76))
    return floor.box("wall", (0.02, 6, 3), (0.6, 0, -0.75))


def share_of_answer(stage: Perception, shot: Shot, *names: str) -> tuple[float, float]:
    """Return precision and recall of the answer for the named things."""
    answer = stage.perceive(shot.request())
    true = shot.pixels(*names)
    hits = np.count_nonzero(true[answer.object_indices])
    assert shot.world_from_camera[2, :3] @ answer.up > np.cos(np.deg2rad(0.5))
    return hits / len(answer.object_indices), hits / np.count_nonzero(true)


@pytest.mark.parametrize(("pitch", "distance"), [(25.0, 1.5), (35.0, 1.0), (60.0, 0.9)])
def test_neither_floor_nor_wall(stage: Perception, pitch: float, distance: float) -> None:
    shot = room().box("box", (0.06, 0.09, 0.05), (0, 0, 0)).shoot(head_camera(pitch, distance))
    precision, recall = share_of_answer(stage, shot, "box")
    assert precision > 0.99
    assert recall > 0.95


def test_a_spoon_in_a_room(stage: Perception, rng: np.random.Generator) -> None:
    shot = spoon(room()).shoot(head_camera(35.0, 1.0)).with_noise(rng, 0.0015)
    precision, recall = share_of_answer(stage, shot, "bowl", "handle")
    assert precision > 0.93
    assert recall > 0.97


def test_a_box_close_to_the_wall(stage: Perception) -> None:
    shot = room().box("box", (0.06, 0.09, 0.05), (0.3, 0.1, 0)).shoot(head_camera(25.0, 1.4))
    precision, recall = share_of_answer(stage, shot, "box")
    assert precision > 0.99
    assert recall > 0.95


def test_a_large_box_is_not_the_table(stage: Perception, rng: np.random.Generator) -> None:
    """Its faces fill more of the image than the table does."""
    for size, at, pitch in (((0.3, 0.45, 0.35), -0.05, 50.0), ((0.3, 0.35, 0.3), -0.15, 35.0)):
        shot = Stage().table().box("big", size, (at, 0, 0)).shoot(head_camera(pitch, 0.9))
        assert np.count_nonzero(shot.pixels("big")) > np.count_nonzero(shot.pixels("table"))
        precision, recall = share_of_answer(stage, shot.with_noise(rng, 0.0015), "big")
        assert precision > 0.99
        assert recall > 0.98


def test_a_stack_is_one_thing_on_the_table(stage: Perception) -> None:
    stack = Stage().table().box("big", (0.25, 0.25, 0.12), (0, 0, 0))
    shot = stack.box("item", (0.05, 0.05, 0.05), (0, 0, 0.12)).shoot()
    precision, recall = share_of_answer(stage, shot, "big", "item")
    assert precision > 0.99
    assert recall > 0.98


@pytest.mark.parametrize("shape", ["box", "ellipsoid"])
def test_a_thing_in_the_air_has_no_plane(stage: Perception, shape: str) -> None:
    shot = getattr(Stage(), shape)("thing", (0.08, 0.06, 0.05), (0, 0, 0)).shoot()
    answer = stage.perceive(shot.request())
    assert answer.plane is None
    assert answer.dropped["support"] == 0
    assert len(answer.object_indices) == np.count_nonzero(shot.pixels("thing"))
    assert np.linalg.norm(answer.up) == pytest.approx(1.0)


def test_an_empty_room_has_no_object(stage: Perception) -> None:
    with pytest.raises(NoObject, match="on the support plane"):
        stage.perceive(room().shoot(head_camera(35.0, 1.0)).request())


def test_the_object_is_on_the_side_of_the_viewpoint(stage: Perception) -> None:
    """In a frame with z up, the default viewpoint below the table is a mistake to point out."""
    shot = Stage().table().box("box", (0.06, 0.09, 0.05), (0, 0, 0)).shoot(size=(240, 320))
    motion = shot.world_from_camera.copy()
    motion[2, 3] += 0.75
    points = shot.cloud() @ motion[:3, :3].T + motion[:3, 3]
    sensor = tuple(motion[:3, 3].tolist())
    answer = stage.perceive(PerceiveRequest(points=points, viewpoint=sensor))
    assert answer.up[2] == pytest.approx(1.0, abs=1e-4)
    with pytest.raises(NoObject, match="is that where the sensor is"):
        stage.perceive(PerceiveRequest(points=points))


def test_a_sensor_in_the_plane_finds_the_side_with_the_objects(stage: Perception) -> None:
    shot = Stage().table().box("box", (0.06, 0.09, 0.05), (0, 0, 0)).shoot(size=(240, 320))
    motion = shot.world_from_camera
    points = shot.cloud() @ motion[:3, :3].T + motion[:3, 3]
    answer = stage.perceive(PerceiveRequest(points=points))  # the origin lies on the table
    assert answer.up[2] == pytest.approx(1.0, abs=1e-4)
    true = shot.pixels("box")
    assert true[answer.object_indices].mean() > 0.99
