"""The thesis's figures, held against the sums that it prints itself."""

from __future__ import annotations

import pytest

from experiments.framework import MeanStd
from experiments.framework.thesis import (
    TABLE_6_3,
    TABLE_6_3_AVERAGE,
    TABLE_6_4,
    TABLE_6_4_AVERAGE,
    TABLE_6_6,
)


@pytest.mark.parametrize("version", ["v1", "v2"])
def test_table_6_4_adds_up(version: str) -> None:
    lines = [line for line in TABLE_6_4 if line.reasoning == version]
    found, accuracy, tpr = TABLE_6_4_AVERAGE[version]
    assert sum(line.found.count for line in lines) == found.count
    assert sum(line.accuracy.mean for line in lines) / 3 == pytest.approx(accuracy, abs=1e-3)
    assert sum(line.tpr.mean for line in lines) / 3 == pytest.approx(tpr, abs=1e-3)


def test_table_6_3_adds_up_where_the_thesis_does() -> None:
    found = {
        version: sum(line.found.count for line in TABLE_6_3 if line.reasoning == version)
        for version in ("v1", "v2")
    }
    assert found["v2"] == TABLE_6_3_AVERAGE["v2"][0].count
    assert (found["v1"], TABLE_6_3_AVERAGE["v1"][0].count) == (156, 164)  # as printed
    assert {line.found.total for line in TABLE_6_3} == {30}
    for version, (_, _, tpr) in TABLE_6_3_AVERAGE.items():
        mean = sum(line.tpr.mean for line in TABLE_6_3 if line.reasoning == version) / 7
        assert mean == pytest.approx(tpr, abs=0.01)


@pytest.mark.parametrize("version", ["v1", "v2"])
def test_table_6_6_adds_up(version: str) -> None:
    stages = [row[version] for name, row in TABLE_6_6.items() if name != "total"]
    seconds = sum(each.mean for each in stages if isinstance(each, MeanStd))
    assert seconds == pytest.approx(TABLE_6_6["total"][version], abs=0.06)
