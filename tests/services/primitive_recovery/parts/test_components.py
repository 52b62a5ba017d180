"""What hangs together in a picture, and what discs cover of it, against scipy's."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import ndimage

from services.primitive_recovery.parts.components import (
    enclosed,
    labelled,
    labelled_by_sides,
    much_the_same,
)
from services.primitive_recovery.parts.discs import opened, within_reach
from services.primitive_recovery.parts.grid import distance_to_unset

SQUARE = np.ones((3, 3), dtype=bool)


def speckled(seed: int) -> NDArray[np.bool_]:
    rng = np.random.default_rng(seed)
    mask = np.asarray(ndimage.gaussian_filter(rng.random((31, 44)), 1.2) > 0.5)
    return mask if seed % 2 else np.asarray(rng.random((17, 23)) < 0.1 * (seed + 1))


@pytest.mark.parametrize("seed", range(8))
def test_components_and_their_numbers(seed: int) -> None:
    mask = speckled(seed)
    for kernel, structure in ((labelled, SQUARE), (labelled_by_sides, None)):
        numbers, sizes = kernel(mask)
        expected, count = ndimage.label(mask, structure=structure)
        np.testing.assert_array_equal(numbers, expected)
        assert sizes.tolist() == np.bincount(expected.ravel(), minlength=count + 1).tolist()


@pytest.mark.parametrize("seed", range(8))
def test_holes_are_what_filling_fills(seed: int) -> None:
    mask = speckled(seed)
    filled = ndimage.binary_fill_holes(mask)
    holes = enclosed(mask, np.zeros_like(mask))
    np.testing.assert_array_equal(holes > 0, filled & ~mask)
    hidden = ~mask
    hidden[::3] = False
    rest = enclosed(mask, hidden)
    np.testing.assert_array_equal(rest > 0, filled & ~mask & ~hidden)
    assert set(np.unique(rest)) == set(range(rest.max() + 1))


@pytest.mark.parametrize("seed", range(8))
def test_discs_reach_as_far_as_the_distance_says(seed: int) -> None:
    mask = speckled(seed)
    for radius in (0.5, 1.0, np.sqrt(5), 4.3):
        expected = distance_to_unset(~mask) <= radius
        np.testing.assert_array_equal(within_reach(mask, radius), expected)


def test_opening_keeps_what_is_linked_to_the_largest() -> None:
    mask = np.zeros((20, 40), dtype=bool)
    mask[3:17, 3:17] = mask[9:11, 17:30] = mask[6:14, 30:38] = True
    body = mask & opened(distance_to_unset(mask), 2.0)
    assert body[10, 10]
    assert not body[10, 24]
    assert not body[10, 34]


def test_masks_that_are_much_the_same() -> None:
    one = np.ones((10, 10), dtype=bool)
    other = one.copy()
    other[0, :3] = False
    assert much_the_same(one, other, 0.96)
    assert not much_the_same(one, other, 0.97)
