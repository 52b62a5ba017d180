from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shared.sorting import ascending, ascending_order, middle, selected, trimmed_range

NUMBERS = st.lists(st.floats(-1e6, 1e6) | st.just(float("inf")), min_size=1, max_size=60)


@settings(deadline=None)  # the first call compiles
@given(NUMBERS)
def test_order_and_median_are_numpys(numbers: list[float]) -> None:
    values = np.array(numbers)
    np.testing.assert_array_equal(ascending(values), np.sort(values))
    np.testing.assert_array_equal(ascending_order(values), np.argsort(values, kind="stable"))
    finite = values[np.isfinite(values)]
    if len(finite):
        assert middle(finite) == pytest.approx(np.median(finite), rel=1e-12)


@pytest.mark.parametrize("count", [1, 2, 700, 701, 5000])
def test_longer_ones_and_the_argument_stays(count: int) -> None:
    values = np.random.default_rng(count).normal(size=count).round(2)
    before = values.copy()
    np.testing.assert_array_equal(ascending(values), np.sort(values))
    np.testing.assert_array_equal(values, before)


def test_nothing_sorts_to_nothing() -> None:
    assert ascending(np.empty(0)).shape == (0,)
    assert ascending_order(np.empty(0)).shape == (0,)


@pytest.mark.parametrize("count", [1, 2, 17, 300])
def test_ranks_and_ranges_are_those_of_the_sorted_values(count: int) -> None:
    values = np.random.default_rng(count).normal(size=count).round(1)
    ordered = np.sort(values)
    for rank in range(0, count, 7):
        held = values.copy()
        assert selected(held, rank) == held[rank] == ordered[rank]
        assert (held[:rank] <= held[rank]).all()
        assert trimmed_range(values, rank) == (ordered[rank], ordered[count - 1 - rank])


@pytest.mark.parametrize("step", [1, -1])
def test_sorted_values_stay_sorted(step: int) -> None:
    values = np.arange(2000.0)
    np.testing.assert_array_equal(ascending(values[::step].copy()), values)
