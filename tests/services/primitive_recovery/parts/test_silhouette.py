"""The picture of an object, and the holes in it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from services.primitive_recovery.parts.openings import count_holes, holes_of
from services.primitive_recovery.parts.view import PartView, part_view

Array = NDArray[np.float64]


def sheet(turn: float, pitch: float = 0.002) -> Array:
    """Return points of a square lattice within a disc of 10 cm, a metre ahead of the origin."""
    side = np.arange(-0.2, 0.2, pitch)
    x, y = (each.ravel() for each in np.meshgrid(side, side))
    c, s = np.cos(turn), np.sin(turn)
    placed = np.column_stack([c * x - s * y, s * x + c * y, np.ones_like(x)])
    return np.asarray(placed[np.hypot(x, y) < 0.1])


def picture_of(points: Array) -> PartView:
    return part_view(points, np.zeros(3), None)


@pytest.mark.parametrize("turn", [0.0, 0.3, np.pi / 4, 1.2])
def test_a_lattice_leaves_no_gaps_however_it_is_turned(turn: float) -> None:
    assert holes_of(picture_of(sheet(turn)).picture.mask).max() == 0


def test_the_spacing_is_that_of_the_points() -> None:
    assert picture_of(sheet(0.4)).spacing == pytest.approx(0.002, rel=0.15)


def test_a_cell_is_never_so_small_that_the_picture_outgrows_its_limit() -> None:
    assert max(picture_of(sheet(0.0, pitch=0.0005)).picture.mask.shape) <= 133


@pytest.mark.parametrize(
    "viewpoint", [(0.0, 0.0, 1.0), (0.01, 0.02, 1.0), (0.0, 0.0, 0.9), (0.0, 0.0, 0.0)]
)
def test_any_viewpoint_gives_a_picture_of_all_points(viewpoint: tuple[float, ...]) -> None:
    points = sheet(0.2)
    points[:, 2] += 0.03 * np.sin(40 * points[:, 0])
    picture = part_view(points, np.array(viewpoint), None).picture
    assert picture.mask.sum() * picture.cell**2 == pytest.approx(np.pi * 0.01, rel=0.25)


def test_holes_are_counted_for_the_part_around_them() -> None:
    points = sheet(0.0)
    x, y = points[:, 0], points[:, 1]
    rings = (np.hypot(x - 0.05, y) > 0.02) & (np.hypot(x + 0.05, y) > 0.02)
    points = points[rings]
    picture = picture_of(points).picture
    one = np.zeros(len(points), dtype=np.int16)
    assert count_holes(picture, one) == (2,)
    assert count_holes(picture, (points[:, 0] > 0).astype(np.int16)) == (1, 1)


def test_a_lost_pixel_is_no_hole() -> None:
    points = sheet(0.0)
    kept = np.hypot(points[:, 0], points[:, 1]) > 0.0015
    picture = picture_of(points[kept]).picture
    assert count_holes(picture, np.zeros(kept.sum(), dtype=np.int16)) == (0,)
