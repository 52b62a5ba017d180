from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from services.grasp_proposal.thinning import thin
from services.grasp_proposal.workspace import _by_height, build_workspace
from shared.errors import EmptyCloud, InvalidInput
from shared.geometry.rotation import quaternion_from_matrix
from shared.geometry.se3 import pose_matrix, transform_points
from shared.schemas.scene import SupportPlane
from tests.services.grasp_proposal.scenes import about_z, lying_cylinder

Array = NDArray[np.float64]

SCENE = lying_cylinder()
TILT = about_z(0.4)[[1, 2, 0]] @ about_z(-1.1)


def test_the_workspace_is_tied_to_the_scene() -> None:
    motion = pose_matrix([3.0, -2.0, 1.0], TILT)
    here = build_workspace(SCENE.request())
    there = build_workspace(SCENE.moved(motion).request())
    assert here.up == pytest.approx([0, 0, 1])
    assert np.allclose(there.outer_from_work, motion @ here.outer_from_work, atol=1e-9)
    assert there.viewpoint == pytest.approx(here.viewpoint, abs=1e-9)
    assert there.support_offset == pytest.approx(here.support_offset, abs=1e-9)


def ball(radius: float, x: float) -> Array:
    """Return a ball as a row of superquadric parameters (12,), its centre above the table."""
    return np.array([1, 1, radius, radius, radius, x, 0.02, 0.03, 0, 0, 0, 1], dtype=np.float64)


def test_the_mass_is_where_the_superquadrics_are() -> None:
    rows = np.array([ball(0.04, 0.0), ball(0.02, 0.09)])
    motion = pose_matrix([3.0, -2.0, 1.0], TILT)
    moved = rows.copy()
    moved[:, 5:8] = transform_points(motion, rows[:, 5:8])
    moved[:, 8:] = quaternion_from_matrix(TILT)
    here = build_workspace(SCENE.request(superquadrics=rows))
    there = build_workspace(SCENE.moved(motion).request(superquadrics=moved))
    outer = transform_points(here.outer_from_work, here.centre_of_mass[None])[0]
    assert outer == pytest.approx([0.01, 0.02, 0.03])
    assert there.centre_of_mass == pytest.approx(here.centre_of_mass, abs=1e-8)
    assert there.believed == pytest.approx(here.believed, abs=1e-8)
    assert here.weight == pytest.approx(9.81 * 400 * 4 / 3 * np.pi * (0.04**3 + 0.02**3))


def test_without_superquadrics_the_mass_is_where_the_points_are() -> None:
    work = build_workspace(SCENE.request())
    assert np.abs(work.centre_of_mass - work.points.mean(axis=0)).max() < 0.005
    assert 9.81 * 0.05 <= work.weight <= 9.81 * 0.6
    assert work.believed.shape == (0, 3)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({6: 1.5}, r"1\.\d+ m away from the points"),
        ({2: 0.0}, "must be finite, .* semi-axes positive"),
        ({2: 1e200}, "nothing beyond 10000"),
        ({0: 1e-300}, r"exponents in 0\.01\.\.4"),
        ({5: np.nan}, "must be finite"),
        ({11: 0.0}, "quaternions not zero"),
    ],
)
def test_superquadrics_of_something_else_are_refused(
    change: dict[int, float], message: str
) -> None:
    row = ball(0.04, 0.0)
    for column, value in change.items():
        row[column] = value
    with pytest.raises(InvalidInput, match=message):
        build_workspace(SCENE.request(superquadrics=row[None]))


def test_heights_are_those_above_the_table() -> None:
    work = build_workspace(SCENE.request())
    outer = transform_points(work.outer_from_work, work.points)
    assert work.heights(work.points) == pytest.approx(outer[:, 2], abs=1e-9)
    free = build_workspace(SCENE.request(plane=None))
    assert np.isinf(free.heights(free.points)).all()


def test_a_plane_with_a_long_normal_is_the_same_plane() -> None:
    long = SupportPlane(normal=(0, 0, 4.0), offset=-2.0, inliers=1, residual_mm=1)
    work = build_workspace(SCENE.request(plane=long))
    outer = transform_points(work.outer_from_work, work.points)
    assert work.heights(work.points) == pytest.approx(outer[:, 2] - 0.5, abs=1e-9)


def test_the_focus_survives_thinning() -> None:
    focus = np.zeros(len(SCENE.points), dtype=bool)
    focus[17] = True
    work = build_workspace(SCENE.request(focus=focus))
    kept = transform_points(work.outer_from_work, work.points[work.in_focus])
    assert np.linalg.norm(kept - SCENE.points[17], axis=1).min() < 1e-9


def test_a_viewpoint_among_the_points_says_nothing() -> None:
    centre = tuple(SCENE.points.mean(axis=0).tolist())
    assert build_workspace(SCENE.request(viewpoint=centre)).viewpoint is None
    assert build_workspace(SCENE.request()).viewpoint is not None


def test_far_obstacles_are_left_out() -> None:
    near, far = np.full((5, 3), 0.2), np.full((50, 3), 30.0)
    work = build_workspace(SCENE.request(obstacle_points=np.vstack([far, near])))
    assert len(work.obstacles) == 5


@pytest.mark.parametrize("scale", [1e-6, 0.1, 100.0])
def test_thinning_bounds_the_count_at_any_scale(scale: float) -> None:
    points = np.random.default_rng(0).uniform(-scale, scale, (60_000, 3))
    kept = thin(points, (0.003, 0.004), 1500)
    assert 1 <= len(kept) <= 20_000
    assert (np.diff(kept) > 0).all()


def test_thinning_keeps_the_first_point_of_each_voxel() -> None:
    points = np.random.default_rng(1).normal(0, 0.02, (5000, 3))
    cells = np.floor((points - points.min(axis=0)) / 0.01)
    first = np.sort(np.unique(cells, axis=0, return_index=True)[1])
    np.testing.assert_array_equal(thin(points, (0.01,), 0), first)


def test_the_order_of_equally_high_points_is_that_of_all_their_coordinates() -> None:
    rng = np.random.default_rng(2)
    points, focus = np.round(rng.uniform(0, 0.04, (300, 3)), 2), rng.random(300) < 0.5
    found, expected = _by_height(points, focus), np.lexsort((focus, *points.T))
    np.testing.assert_array_equal(points[found], points[expected])
    np.testing.assert_array_equal(focus[found], focus[expected])


def test_thinning_leaves_a_point_near_every_point() -> None:
    kept = SCENE.points[thin(SCENE.points, (0.003,), 0)]
    gaps = np.linalg.norm(SCENE.points[::20, None] - kept[None], axis=2).min(axis=1)
    assert gaps.max() <= 0.003 * np.sqrt(3)
    assert len(kept) < len(SCENE.points)


@pytest.mark.parametrize(
    ("changes", "said", "error"),
    [
        ({"points": np.zeros((9, 3))}, "9 points", EmptyCloud),
        ({"points": np.empty((0, 3))}, "0 points", EmptyCloud),
        ({"points": np.full((20, 3), np.nan)}, "points must be finite", InvalidInput),
        ({"points": np.full((20, 3), 1e200)}, "metres", InvalidInput),
        ({"obstacle_points": np.full((2, 3), np.inf)}, "obstacle_points must", InvalidInput),
        ({"focus": np.ones(3, dtype=bool)}, "focus has 3 entries", InvalidInput),
        ({"focus": np.zeros(len(SCENE.points), dtype=bool)}, "no true entry", InvalidInput),
        ({"viewpoint": (0, 0, -1e5)}, "viewpoint is", InvalidInput),
    ],
)
def test_bad_input_is_named(
    changes: dict[str, object], said: str, error: type[InvalidInput]
) -> None:
    with pytest.raises(error, match=said):
        build_workspace(SCENE.request(**changes))
