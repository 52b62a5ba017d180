"""Worse views: how much worse, and of what."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from services.viewer.disturbance import Disturbance
from services.viewer.sources import Seen
from shared.schemas.scene import View

Mask = NDArray[np.bool_]
UP = (0.0, -1.0, 0.0)  # a camera that looks level: x to the right, y down, z forward


def board(viewpoint: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> tuple[Seen, Mask]:
    """A board at 1 m, the object its middle square of 0.2 m."""
    x, y = np.meshgrid(np.linspace(-0.4, 0.4, 81), np.linspace(-0.4, 0.4, 81))
    points = np.column_stack([x.ravel(), y.ravel(), np.ones(x.size)]) + viewpoint
    return Seen.of(View(points=points, viewpoint=viewpoint)), middle(points - viewpoint)


def image() -> tuple[Seen, Mask]:
    depth = np.full((60, 80), 1000, dtype=np.uint16)
    intrinsics = np.array([[100.0, 0, 40], [0, 100.0, 30], [0, 0, 1]])
    seen = Seen.of(View(depth=depth, intrinsics=intrinsics, depth_scale=0.001))
    return seen, middle(seen.points)


def middle(points: NDArray[np.float64]) -> Mask:
    inside: Mask = np.all(np.abs(points[:, :2]) <= 0.1 + 1e-9, axis=1)
    return inside


def test_nothing_changes_nothing() -> None:
    seen, inside = board()
    assert Disturbance().of(seen, inside, UP) is seen


@pytest.mark.parametrize("viewpoint", [(0.0, 0.0, 0.0), (0.3, -0.2, 0.5)])
def test_so_much_of_the_object_is_hidden_from_its_left(viewpoint: tuple[float, ...]) -> None:
    seen, inside = board(viewpoint)  # type: ignore[arg-type]
    left = Disturbance(hidden=0.4).of(seen, inside, UP)
    gone: Mask = ~np.all(np.isfinite(left.points), axis=1)
    assert gone[inside].mean() == pytest.approx(0.4, abs=0.06)
    x = seen.points[:, 0]
    assert x[inside & gone].max() < x[inside & ~gone].min()
    far = np.abs(seen.points - viewpoint)[:, 1] > 0.2
    assert not gone[far].any(), "what is above and below is still seen"


def test_a_hidden_pixel_returns_nothing() -> None:
    seen, inside = image()
    left = Disturbance(hidden=0.5).of(seen, inside, UP)
    assert left.view.depth is not None
    assert left.view.depth.dtype == np.uint16
    gone = left.view.depth.ravel() == 0
    assert gone[inside].mean() == pytest.approx(0.5, abs=0.06)
    assert seen.view.depth is not None
    assert (seen.view.depth > 0).all(), "the first view is as it was"


@pytest.mark.parametrize("make", [board, image])
def test_noise_is_along_the_sight_and_as_large_as_said(make: object) -> None:
    seen, inside = make()  # type: ignore[operator]
    noisy = Disturbance(noise_mm=5.0).of(seen, inside, UP)
    near = np.linalg.norm(seen.points, axis=1) < 1.1
    moved = noisy.points - seen.points
    sight = seen.points / np.linalg.norm(seen.points, axis=1, keepdims=True)
    along = (moved * sight).sum(axis=1)
    assert np.std(along[near]) == pytest.approx(0.005, rel=0.15)
    across = moved - along[:, None] * sight
    assert np.abs(across).max() < 1e-9
    again = Disturbance(noise_mm=5.0).of(seen, inside, UP)
    np.testing.assert_array_equal(again.points, noisy.points)
