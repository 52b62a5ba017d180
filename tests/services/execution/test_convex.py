from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from services.execution.convex import ConvexPart, convex_hull
from shared.geometry.se3 import transform_points
from tests.services.execution.scenes import CAMERA_FROM_WORLD, box


def part_of(half: tuple[float, float, float], centre: tuple[float, float, float]) -> ConvexPart:
    return ConvexPart(*box(half, centre))


def test_moments_of_a_box() -> None:
    half, centre = np.array([0.02, 0.03, 0.05]), np.array([0.3, -0.2, 0.7])
    volume, centroid, second = part_of(tuple(half), tuple(centre)).moments()
    assert volume == pytest.approx(8 * half.prod())
    assert centroid == pytest.approx(centre)
    about_centre = second / volume - np.outer(centre, centre)
    assert about_centre == pytest.approx(np.diag(half**2 / 3), abs=1e-9)


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), share=st.floats(0.05, 0.95))
def test_a_plane_divides_volume_and_centroid(seed: int, share: float) -> None:
    points = np.random.default_rng(seed).normal(scale=0.05, size=(30, 3))
    whole = convex_hull(points)
    assert whole is not None
    low, high = points[:, 2].min(), points[:, 2].max()
    height = low + share * (high - low)
    mirror = np.diag([1.0, 1.0, -1.0, 1.0])
    flipped = convex_hull(transform_points(mirror, points))
    assert flipped is not None
    upper, lower = whole.above(height), flipped.above(-height)
    moments = [part.moments()[:2] for part in (upper, lower) if part is not None]
    moments[-1] = (moments[-1][0], moments[-1][1] * [1, 1, -1])
    volume, centroid, _ = whole.moments()
    if len(moments) == 2:
        assert sum(v for v, _ in moments) == pytest.approx(volume, rel=1e-6)
        assert sum(v * c for v, c in moments) == pytest.approx(volume * centroid, abs=1e-9)
    if upper is not None:
        assert upper.vertices[:, 2].min() >= height - 1e-12


def test_moving_keeps_the_volume_and_moves_the_centroid() -> None:
    part = part_of((0.02, 0.03, 0.05), (0.1, 0.0, 0.0))
    volume, centroid, _ = part.moments()
    moved_volume, moved_centroid, _ = part.moved(CAMERA_FROM_WORLD).moments()
    assert moved_volume == pytest.approx(volume)
    assert moved_centroid == pytest.approx(transform_points(CAMERA_FROM_WORLD, centroid[None])[0])


@pytest.mark.parametrize(
    "points",
    [
        np.empty((0, 3)),
        np.zeros((10, 3)),
        np.eye(3),
        np.random.default_rng(0).normal(size=(20, 3)) * [1, 1, 0],
        np.linspace(0, 1, 20)[:, None] * [1.0, 2.0, 3.0],
        np.random.default_rng(0).normal(size=(20, 3)) * 1e-6,
    ],
)
def test_no_volume_has_no_hull(points: np.ndarray) -> None:
    assert convex_hull(points) is None


def test_nothing_is_left_above_the_top() -> None:
    assert part_of((0.02, 0.02, 0.02), (0, 0, 0)).above(0.03) is None
