"""Shares and means against their definitions."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from experiments.framework import MeanStd, Share
from experiments.framework.cells import fields_of, text_of


@pytest.mark.parametrize(
    ("count", "total", "low", "high"),
    [(0, 10, 0.0, 0.27753), (10, 10, 0.72247, 1.0), (5, 10, 0.23659, 0.76341), (1, 1, 0.20654, 1)],
)
def test_the_interval_is_wilsons(count: int, total: int, low: float, high: float) -> None:
    assert Share(count, total).interval == pytest.approx((low, high), abs=1e-4)


@given(st.integers(0, 500), st.integers(1, 500))
def test_an_interval_holds_its_share_and_mirrors(count: int, more: int) -> None:
    share, rest = Share(count, count + more), Share(more, count + more)
    low, high = share.interval
    assert 0 <= low <= share.value <= high <= 1
    assert rest.interval == pytest.approx((1 - high, 1 - low))


def test_an_interval_narrows_with_more_views() -> None:
    widths = [high - low for low, high in (Share(3 * k, 10 * k).interval for k in (1, 3, 10, 100))]
    assert widths == sorted(widths, reverse=True)


def test_nothing_is_no_share() -> None:
    assert Share.of([]).text() == "–"
    assert math.isnan(Share(0, 0).value)
    assert Share(0, 0).interval == (0.0, 1.0)


@pytest.mark.parametrize(("count", "total"), [(-1, 3), (4, 3)])
def test_more_than_all_is_refused(count: int, total: int) -> None:
    with pytest.raises(ValueError, match="no share"):
        Share(count, total)


def test_mean_and_deviation_pass_over_what_is_missing() -> None:
    both = MeanStd.of([1.0, None, 2.0, 3.0])
    assert (both.mean, both.std, both.count) == (2.0, 1.0, 3)
    assert MeanStd.of([0.5]).std == 0.0
    assert MeanStd.of([None]).text() == "–"


def test_cells_as_text_and_as_fields() -> None:
    assert Share(12, 30).text() == "12/30 (40 %, 25–58)"
    assert text_of(Share(12, 30), brief=True) == "12/30"
    assert text_of(MeanStd(0.814, 0.123, 9)) == "0.81 ± 0.12"
    assert [text_of(cell) for cell in (None, math.nan, True, 0.1234, 1234.5, "x", 7)] == [
        "–", "–", "yes", "0.123", "1234.5", "x", "7",
    ]  # fmt: skip
    assert fields_of("good", Share(1, 2)).keys() == {
        "good count", "good total", "good low", "good high",
    }  # fmt: skip
    assert fields_of("iou", None) == {"iou": ""}
