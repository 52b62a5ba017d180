"""The camera: geometry against closed forms, noise against its law."""

from __future__ import annotations

import numpy as np
import pytest

from experiments.camera import (
    D435,
    HeadCamera,
    Rendering,
    StereoNoise,
    Table,
    label_image,
    look_at,
    place_on,
    render,
)
from experiments.catalogue import build, resting_pose
from shared.geometry.points import points_from_depth
from shared.geometry.se3 import transform_points

TABLE, HEAD = Table(), HeadCamera()


@pytest.fixture(scope="module")
def pan_view() -> Rendering:
    pan = build("saucepan")
    standing = resting_pose(pan, (0, 0, 1))
    world_from_object = place_on(TABLE, pan, standing, position=(0.65, 0.0), yaw_deg=200)
    return render(pan, world_from_object, TABLE, D435, HEAD.world_from_camera)


def in_world(rendering: Rendering) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    points = points_from_depth(rendering.depth, D435.intrinsics, 1.0)
    return transform_points(HEAD.world_from_camera, points).reshape(480, 640, 3)


def test_look_at_is_an_optical_frame() -> None:
    pose = look_at((0, 0, 1.3), (0.65, 0, 0.8))
    right, down, ahead = pose[:3, :3].T
    np.testing.assert_allclose(pose[:3, :3].T @ pose[:3, :3], np.eye(3), atol=1e-12)
    np.testing.assert_allclose(right, [0, -1, 0], atol=1e-12)
    assert down[2] < 0 < ahead[0]
    np.testing.assert_allclose(np.cross(right, down), ahead, atol=1e-12)


def test_the_table_is_where_it_should_be(pan_view: Rendering) -> None:
    table = in_world(pan_view)[pan_view.on_table]
    top = table[table[:, 0] > TABLE.near + 1e-4]
    np.testing.assert_allclose(top[:, 2], TABLE.height, atol=2e-6)
    assert top[:, 0].max() < TABLE.near + TABLE.depth + 1e-4
    assert np.abs(top[:, 1]).max() < TABLE.width / 2 + 1e-4
    assert pan_view.depth[pan_view.on_table].min() > 0.55
    assert pan_view.depth[pan_view.on_table].max() < 1.15


def test_the_object_stands_on_the_table(pan_view: Rendering) -> None:
    pan = in_world(pan_view)[pan_view.part >= 0]
    assert pan[:, 2].min() > TABLE.height - 1e-5
    assert pan[:, 2].max() == pytest.approx(TABLE.height + 0.105, abs=0.012)


def test_labels_tell_parts_from_table(pan_view: Rendering) -> None:
    labels = label_image(build("saucepan"), pan_view)
    assert set(np.unique(labels)) == {0, 1, 2, 3}
    names = [part.name for part in build("saucepan").parts]
    np.testing.assert_array_equal(labels == 2, pan_view.part == names.index("handle"))
    np.testing.assert_array_equal(labels == 1, pan_view.on_table)
    np.testing.assert_array_equal(labels == 0, pan_view.depth == 0)


@pytest.mark.parametrize("distance", [0.6, 1.0, 1.5])
def test_noise_grows_with_the_square_of_the_depth(distance: float) -> None:
    flat = np.full((300, 400), distance)
    noisy = StereoNoise().apply(flat, np.random.default_rng(0))
    assert (noisy > 0).all()
    assert noisy.mean() == pytest.approx(distance, abs=3e-4)
    assert noisy.std() == pytest.approx(1.5e-3 * distance**2, rel=0.1)


def test_depth_comes_in_steps_of_disparity() -> None:
    noise = StereoNoise()
    noisy = noise.apply(np.full((100, 100), 0.8), np.random.default_rng(0))
    steps = 1 / noisy / noise.step_at_1m
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-6)


def test_only_edges_drop_out() -> None:
    depth = np.full((40, 60), 1.0)
    depth[:, 30:] = 0.7
    noisy = StereoNoise(edge_dropout=1.0).apply(depth, np.random.default_rng(0))
    lost = noisy == 0
    np.testing.assert_array_equal(lost.any(axis=0), (np.arange(60) == 29) | (np.arange(60) == 30))


def test_no_return_stays_no_return() -> None:
    depth = np.zeros((20, 20))
    np.testing.assert_array_equal(StereoNoise().apply(depth, np.random.default_rng(0)), 0)
