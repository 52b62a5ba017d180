"""Laws of rigid motions, planes and pinhole cameras."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from shared.geometry.plane import fit_plane, height_above, plane_basis
from shared.geometry.points import points_from_depth, principal_axes, tail_signs
from shared.geometry.rotation import (
    frame_from_z,
    matrix_from_quaternion,
    quaternion_from_matrix,
    unit,
)
from shared.geometry.se3 import (
    inverse,
    matrix_from_pose,
    pose_from_matrix,
    transform_points,
)

coordinate = st.floats(-10, 10)
vector = st.tuples(coordinate, coordinate, coordinate).map(np.array)
direction = vector.filter(lambda v: np.linalg.norm(v) > 1e-3)
quaternion = st.tuples(coordinate, coordinate, coordinate, coordinate).filter(
    lambda q: np.linalg.norm(q) > 1e-3
)


@given(vector, quaternion)
def test_a_motion_and_its_inverse_cancel(position: np.ndarray, q: tuple[float, ...]) -> None:
    a_from_b = matrix_from_pose(position, q)
    np.testing.assert_allclose(a_from_b @ inverse(a_from_b), np.eye(4), atol=1e-9)


@given(vector, quaternion)
def test_pose_and_matrix_round_trip(position: np.ndarray, q: tuple[float, ...]) -> None:
    motion = matrix_from_pose(position, q)
    np.testing.assert_allclose(matrix_from_pose(*pose_from_matrix(motion)), motion, atol=1e-9)


@given(quaternion)
def test_quaternions_are_xyzw_with_positive_w(q: tuple[float, ...]) -> None:
    found = quaternion_from_matrix(matrix_from_quaternion(q))
    expected = unit_quaternion(q)
    assert found[3] >= 0
    assert abs(found @ expected) > 1 - 1e-9


@given(st.lists(quaternion, min_size=1, max_size=4))
def test_matrices_are_those_of_scipy(several: list[tuple[float, ...]]) -> None:
    q = np.array(several)
    expected = Rotation.from_quat(q).as_matrix()
    np.testing.assert_allclose(matrix_from_quaternion(q), expected, atol=1e-12)
    np.testing.assert_allclose(matrix_from_quaternion(7.0 * q[0]), expected[0], atol=1e-12)


def test_a_quaternion_of_zeros_turns_nothing() -> None:
    with pytest.raises(ValueError, match="zero"):
        matrix_from_quaternion([0.0, 0.0, 0.0, 0.0])


def unit_quaternion(q: tuple[float, ...]) -> np.ndarray:
    return np.asarray(np.array(q) / np.linalg.norm(q))


def test_a_quarter_turn_about_z() -> None:
    half = np.sqrt(0.5)
    moved = transform_points(
        matrix_from_pose([1, 0, 0], [0, 0, half, half]), np.array([[1.0, 0, 0]])
    )
    np.testing.assert_allclose(moved, [[1, 1, 0]], atol=1e-12)


@given(direction, vector)
@example(np.array([0.0, 6e-8, 3.0]), np.array([0.0, 0.0, 1.0]))
def test_frames_are_right_handed(z: np.ndarray, hint: np.ndarray) -> None:
    frame = frame_from_z(z, hint)
    np.testing.assert_allclose(frame.T @ frame, np.eye(3), atol=1e-9)
    assert np.linalg.det(frame) > 0
    np.testing.assert_allclose(frame[:, 2], unit(z), atol=1e-12)


def test_the_hint_becomes_x() -> None:
    np.testing.assert_allclose(frame_from_z([0, 0, 2], [3, 0, 5])[:, 0], [1, 0, 0])


def test_zero_has_no_direction() -> None:
    np.testing.assert_array_equal(unit([0, 0, 0]), [0, 0, 0])


@given(direction, st.floats(-2, 2))
def test_a_fitted_plane_holds_its_points(normal: np.ndarray, offset: float) -> None:
    n = unit(normal)
    grid = np.stack(np.meshgrid([0, 0.1, 0.2], [0, 0.3, 0.5]), axis=-1).reshape(-1, 2)
    points = grid @ plane_basis(n).T - offset * n
    found, d = fit_plane(points)
    assert np.abs(height_above(points, found, d)).max() < 1e-9
    assert abs(found @ n) > 1 - 1e-9


def test_depth_is_projected_row_major_and_skips_no_return() -> None:
    intrinsics = np.array([[100.0, 0, 1], [0, 50.0, 0.5], [0, 0, 1]])
    depth = np.array([[2000, 0, 1000], [1000, 1000, 1000]], dtype=np.uint16)
    points = points_from_depth(depth, intrinsics, 1e-3)
    np.testing.assert_allclose(points[0], [-0.02, -0.02, 2.0])
    np.testing.assert_allclose(points[5], [0.01, 0.01, 1.0])
    assert np.isnan(points[1]).all()


def test_principal_axes_are_sorted_and_right_handed(rng: np.random.Generator) -> None:
    points = rng.normal(size=(500, 3)) * [0.1, 3.0, 1.0]
    variances, axes = principal_axes(points)
    assert (np.diff(variances) <= 0).all()
    assert np.linalg.det(axes) > 0
    assert abs(axes[1, 0]) > 0.99


def test_tail_signs_turn_axes_the_same_way_whichever_way_they_came() -> None:
    placed = np.random.default_rng(4).exponential(size=(500, 3)) - 1.0
    for flip in ([1.0, 1.0, 1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, -1.0]):
        np.testing.assert_array_equal(tail_signs(placed * flip), flip)
    np.testing.assert_array_equal(tail_signs(np.zeros((4, 2))), [1.0, 1.0])
