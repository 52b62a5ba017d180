"""The camera: geometry against closed forms, noise against its law."""

from __future__ import annotations

import numpy as np
import pytest

from experiments.camera import (
    D435,
    HeadCamera,
    PinholeCamera,
    Rendering,
    StereoNoise,
    Table,
    label_image,
    look_at,
    place_on,
    region_masks,
    render,
)
from experiments.catalogue import build, resting_pose
from shared.geometry.points import points_from_depth
from shared.geometry.rotation import frame_from_z
from shared.geometry.se3 import inverse, pose_matrix, transform_points
from tests.support.bricks import brick, row

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


PAIR = row(
    (0.1, 0.1, 0.1),
    {"left": 1000.0, "right": 1000.0},
    {"first": ("left",), "all": ("left", "right")},
)


def distance_to_box(
    rays: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
    box_from_camera: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
    size: tuple[float, float, float],
) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """The depth at which rays through the camera's origin enter a box about its own origin.

    The slab method (Kay and Kajiya, 1986); infinite where they miss it.
    """
    origin = box_from_camera[:3, 3]
    directions = rays @ box_from_camera[:3, :3].T
    directions = np.where(directions == 0, 1e-300, directions)
    half = np.array(size) / 2
    near_far = np.stack([(-half - origin) / directions, (half - origin) / directions])
    enters, leaves = near_far.min(axis=0).max(axis=-1), near_far.max(axis=0).min(axis=-1)
    return np.where(enters < leaves, enters, np.inf)


def test_depth_is_that_of_the_closed_form() -> None:
    """A tilted brick and the table top, against slabs: exact but for single precision."""
    size = (0.2, 0.12, 0.08)
    world_from_brick = pose_matrix((0.7, 0.05, 1.0), frame_from_z((1, 2, 3)))
    seen = render(brick(size), world_from_brick, TABLE, D435, HEAD.world_from_camera)
    low, high = TABLE.corners
    table_pose = pose_matrix((low + high) / 2, np.eye(3))
    of_brick, of_table = (
        distance_to_box(D435.rays(), inverse(pose) @ HEAD.world_from_camera, extent)
        for pose, extent in (
            (world_from_brick, size),
            (table_pose, tuple((high - low).tolist())),
        )
    )
    nearest = np.minimum(of_brick, of_table)
    expected = np.where(np.isfinite(nearest), nearest, 0.0)
    at_outline = np.abs(seen.depth - expected) > 2e-6
    assert at_outline.sum() < 10
    wrong_part = (seen.part == 0) != (np.isfinite(of_brick) & (of_brick <= of_table))
    assert (wrong_part & ~at_outline).sum() == 0
    assert (seen.part == 0).sum() > 5000


def test_what_stands_in_front_hides_and_is_no_part() -> None:
    size = (0.1, 0.1, 0.1)
    camera = PinholeCamera(64, 48, 60.0)
    target, front = pose_matrix((0.8, 0, 0.9), np.eye(3)), pose_matrix((0.5, 0, 0.95), np.eye(3))
    alone = render(brick(size), target, TABLE, camera, HEAD.world_from_camera)
    other = [(PAIR, front)]
    crowded = render(brick(size), target, TABLE, camera, HEAD.world_from_camera, other)
    hidden = crowded.depth != alone.depth
    assert (alone.part == 0).sum() > (crowded.part == 0).sum() > 0
    assert hidden.sum() > 50
    assert ((crowded.depth < alone.depth) | (alone.depth == 0))[hidden].all()
    assert (crowded.part[hidden] == -1).all()
    assert not crowded.on_table[hidden].any()
    np.testing.assert_array_equal(crowded.part[~hidden], alone.part[~hidden])
    labels = label_image(brick(size), crowded)
    assert (labels[hidden] == 0).all()


def test_a_part_of_two_regions_is_in_both_masks() -> None:
    """The label image has room for one: the first task's."""
    pose = pose_matrix((0.6, 0, 0.85), np.eye(3))
    seen = render(PAIR, pose, TABLE, D435, HEAD.world_from_camera)
    first, both = region_masks(PAIR, seen)
    np.testing.assert_array_equal(first, seen.part == 0)
    np.testing.assert_array_equal(both, seen.part >= 0)
    labels = label_image(PAIR, seen)
    np.testing.assert_array_equal(labels == 2, first)
    np.testing.assert_array_equal(labels == 3, both & ~first)


def test_correlated_noise_is_as_large_and_smoother() -> None:
    flat = np.full((200, 300), 1.0)
    lone, joint = (
        StereoNoise(correlation_px=radius, step_at_1m=1e-9).apply(flat, np.random.default_rng(1))
        for radius in (0.0, 2.0)
    )
    assert joint.std() == pytest.approx(lone.std(), rel=0.1)
    for noisy, expected in ((lone, 0.0), (joint, np.exp(-1 / 16))):  # exp(-d^2 / 4 sigma^2)
        error = noisy - noisy.mean()
        for one, other in ((error[:, 1:], error[:, :-1]), (error[1:], error[:-1])):
            assert (one * other).mean() / error.var() == pytest.approx(expected, abs=0.03)


def test_scaled_noise_has_larger_errors() -> None:
    flat = np.full((200, 300), 0.9)
    one, four = (
        StereoNoise().scaled(factor).apply(flat, np.random.default_rng(0)).std()
        for factor in (1, 4)
    )
    assert four == pytest.approx(4 * one, rel=0.05)
