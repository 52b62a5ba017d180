"""Scenes: on the table, in the image, at random."""

from __future__ import annotations

import numpy as np
import pytest

from experiments.camera import D435
from experiments.catalogue import build
from experiments.dataset.drop import Body, body_of
from experiments.dataset.scene import IMAGE_MARGIN_PX, TABLE_HEIGHTS, draw_scene, in_image
from shared.errors import InvalidInput
from shared.geometry.se3 import transform_points
from tests.support.bricks import brick


@pytest.fixture(scope="module")
def pan() -> Body:
    return body_of(build("pan1"))


@pytest.mark.parametrize("number", range(8))
def test_the_object_is_on_the_table_and_in_the_image(pan: Body, number: int) -> None:
    scene = draw_scene(pan, number, np.random.default_rng(number))
    assert scene.table.height == TABLE_HEIGHTS[number % 2]
    assert scene.camera_from_world[2, :3] @ [0, 0, 1] < 0  # the camera looks down
    world = transform_points(scene.world_from_object, pan.thing.vertices)
    assert world[:, 2].min() == pytest.approx(scene.table.height, abs=1e-9)
    low, high = scene.table.corners
    assert (world[:, :2] > low[:2]).all()
    assert (world[:, :2] < high[:2]).all()
    seen = transform_points(scene.camera_from_object, pan.thing.vertices)
    assert in_image(seen, D435, IMAGE_MARGIN_PX)
    assert 0.5 < np.linalg.norm(seen, axis=1).min() < np.linalg.norm(seen, axis=1).max() < 1.3


def test_a_point_leaves_the_image_where_the_pixels_end() -> None:
    for u, v in ((0.1, 0.1), (638.9, 478.9)):
        ray = np.array([[(u - 320) / 615, (v - 240) / 615, 1.0]])
        assert in_image(ray, D435)
        assert not in_image(ray, D435, margin_px=1.0)
        assert not in_image(1.01 * (ray - [0, 0, 1]) + [0, 0, 1], D435)
        assert not in_image(-ray, D435)


def test_poses_come_with_their_probabilities_and_any_yaw() -> None:
    body = body_of(brick((0.12, 0.08, 0.04)))
    ups, ahead = [], []
    rng = np.random.default_rng(0)
    for number in range(300):
        rotation = draw_scene(body, number, rng).world_from_object[:3, :3]
        ups.append(int(np.abs(rotation[2]).argmax()))
        ahead.append(np.arctan2(*(rotation[1::-1, (ups[-1] + 1) % 3])))
    for axis in range(3):
        expected = sum(p.probability for p in body.poses if abs(p.up[axis]) > 0.9)
        assert ups.count(axis) / 300 == pytest.approx(expected, abs=0.07)
    quarters, _ = np.histogram(ahead, bins=4, range=(-np.pi, np.pi))
    assert quarters.min() > 50


def test_the_same_numbers_make_the_same_scene(pan: Body) -> None:
    one, other, third = (draw_scene(pan, 0, np.random.default_rng(seed)) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one.world_from_object, other.world_from_object)
    assert not np.array_equal(one.world_from_object, third.world_from_object)


def test_what_does_not_fit_is_named_with_its_size() -> None:
    shelf = body_of(brick((3.0, 0.5, 0.5), "shelf"))
    with pytest.raises(InvalidInput, match=r"'shelf' does not fit.* 3\.000 x 0\.500"):
        draw_scene(shelf, 0, np.random.default_rng(0))
