"""What hides from the sensor, and which slender piece goes on behind another."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from services.perception.shadow import goes_on_behind, hidden

Array = NDArray[np.float64]

SENSOR = np.array([0.0, 0.0, 0.8])
VOXEL = 0.004


def grid(*ranges: tuple[float, float]) -> Array:
    """Return the points of a box, one per voxel."""
    axes = [np.arange(low, high + 1e-9, VOXEL) for low, high in ranges]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def wall() -> Array:
    """Return an upright wall 8 cm high and wide; it throws a shadow from x = 0.4 to 0.444."""
    return grid((0.4, 0.4), (-0.04, 0.04), (0.0, 0.08))


def bar(start: float = 0.448, aside: float = 0.0) -> Array:
    """Return a bar on the table, 15 cm long, that leads away from the sensor."""
    return grid((start, start + 0.15), (aside - 0.006, aside + 0.006), (0.004, 0.004))


def test_a_sample_is_hidden_by_what_is_before_it_on_its_ray() -> None:
    behind = np.array([[0.43, 0.0, 0.01], [0.43, 0.03, 0.01]])
    in_sight = np.array([[0.48, 0.0, 0.01], [0.43, 0.07, 0.01], [0.36, 0.0, 0.04]])
    assert hidden(behind, wall(), SENSOR, VOXEL).all()
    assert not hidden(in_sight, wall(), SENSOR, VOXEL).any()


def test_a_single_point_hides() -> None:
    assert hidden(np.array([[0.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 0.4]]), SENSOR, VOXEL).all()


def test_a_bar_that_the_shadow_cuts_off_goes_on() -> None:
    assert goes_on_behind(bar(), wall(), SENSOR, 0.12, VOXEL)


@pytest.mark.parametrize(
    "other",
    [
        bar(start=0.48),  # its end is in sight
        bar(aside=0.075),  # beside the shadow
        grid((0.448, 0.5), (-0.03, 0.03), (0.004, 0.004)),  # not slender
        grid((0.448, 0.456), (-0.03, 0.09), (0.004, 0.004)),  # across, past the wall
    ],
)
def test_others_do_not(other: Array) -> None:
    assert not goes_on_behind(other, wall(), SENSOR, 0.12, VOXEL)


def test_it_goes_on_no_further_than_the_reach() -> None:
    assert not goes_on_behind(bar(), wall(), SENSOR, 0.03, VOXEL)
