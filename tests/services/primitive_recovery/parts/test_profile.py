"""Slices of clouds whose widths are known."""

from __future__ import annotations

import numpy as np
import pytest

from services.primitive_recovery.parts.coverage import coverage
from services.primitive_recovery.parts.profile import (
    SLICES,
    filled_share,
    interpolated,
    profile,
    slice_ranges,
)

RAY = np.array([0.0, 0.0, 1.0])
AXIS = np.array([1.0, 0.0, 0.0])


def test_widths_of_a_wedge(rng: np.random.Generator) -> None:
    points = rng.uniform(-1, 1, (40_000, 3)) * np.array([0.1, 1.0, 0.01])
    points[:, 1] *= 0.02 + 0.1 * (points[:, 0] + 0.1)  # half widths 0.02 to 0.04
    found = profile(points, AXIS, RAY, np.zeros(len(points)), 0.001)
    expected = 2 * (0.02 + 0.02 * (np.arange(SLICES) + 0.5) / SLICES)
    # two percent of the points are left out at either edge
    np.testing.assert_allclose(found.width, 0.96 * expected, rtol=0.05)
    assert found.length == pytest.approx(0.2, rel=0.01)


def test_a_gap_is_bridged(rng: np.random.Generator) -> None:
    points = rng.uniform(-1, 1, (20_000, 3)) * np.array([0.1, 0.03, 0.01])
    kept = points[np.abs(points[:, 0]) > 0.02]
    found = profile(kept, AXIS, RAY, np.zeros(len(kept)), 0.001)
    np.testing.assert_allclose(found.width, 0.96 * 0.06, rtol=0.05)


def test_background_between_two_legs_is_not_filled() -> None:
    x, y = (each.ravel() for each in np.mgrid[-0.1:0.1:0.001, -0.03:0.03:0.001])
    solid = np.column_stack([x, y, 0 * x])
    fork = solid[(x < 0) | (np.abs(y) > 0.015)]
    found = profile(fork, AXIS, RAY, np.zeros(len(fork)), 0.001)
    assert found.filled[: SLICES // 2 - 2].min() > 0.95
    assert found.filled[SLICES // 2 + 2 :].mean() == pytest.approx(0.5, abs=0.07)


def test_ranges_against_sorting(rng: np.random.Generator) -> None:
    index = rng.integers(0, 5, 300)
    index[index == 3] = 4
    values = rng.normal(size=(2, 300))
    number, ranges, mean = slice_ranges(values, index, 5, np.array([0.0, 0.1]))
    assert number.tolist() == np.bincount(index, minlength=5).tolist()
    for each in (0, 1, 2, 4):
        own = np.sort(values[:, index == each], axis=1)
        skip = int(0.1 * own.shape[1])
        assert ranges[0, :, each].tolist() == [own[0, 0], own[0, -1]]
        assert ranges[1, :, each].tolist() == [own[1, skip], own[1, -1 - skip]]
        assert mean[each] == pytest.approx(own[1].mean())


def test_interpolation_is_numpys(rng: np.random.Generator) -> None:
    wanted, at = np.arange(0.5, SLICES), np.linspace(1.6, SLICES - 1.6, 20)
    values = rng.normal(size=(3, 20))
    for known in (rng.random(20) < 0.6, np.arange(20) == 7):
        expected = [np.interp(wanted, at[known], row[known]) for row in values]
        np.testing.assert_array_equal(interpolated(wanted, at, known, values), expected)


def test_filled_share_of_known_cells() -> None:
    side = np.array([0.0, 1.0, 3.0, 0.0])
    index = np.array([0, 0, 0, 1])
    share = filled_share(side, index, np.array([0.0, 0.0]), np.array([3.5, 0.5]), 1.0)
    assert share.tolist() == [0.75, 1.0]


def test_an_ellipse_covers_no_background() -> None:
    x = (np.arange(SLICES) + 0.5) / SLICES * 2 - 1
    lower, upper, whole = coverage(np.sqrt(1 - x**2))
    assert whole == pytest.approx(0.0, abs=1e-9)
    assert lower[0] == upper[-1] == 0.0


def test_a_cut_at_the_neck_covers_least() -> None:
    width = np.where(np.arange(SLICES) < 40, 0.07, 0.03)
    lower, upper, whole = coverage(width)
    assert int(np.argmin(lower + upper)) == 40
    assert whole > 0.15
    np.testing.assert_allclose(coverage(width[::-1])[0][::-1], upper)
