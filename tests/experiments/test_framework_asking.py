"""Working on many views at a time."""

from __future__ import annotations

import threading
import time

import pytest
from rich.console import Console

from experiments.framework.asking import mapped

QUIET = Console(quiet=True)


@pytest.mark.parametrize("workers", [1, 3])
def test_results_come_in_the_order_of_the_items(workers: int) -> None:
    def slow_first(item: int) -> int:
        time.sleep(0.02 if item == 0 else 0)
        return item * item

    results = mapped(slow_first, range(20), workers=workers, console=QUIET, describe="")
    assert results == [item * item for item in range(20)]


def test_as_many_are_under_way_as_there_are_workers() -> None:
    both = threading.Barrier(2, timeout=10)
    mapped(lambda _: both.wait(), range(2), workers=2, console=QUIET, describe="")
    assert not both.broken


def test_the_first_error_ends_it() -> None:
    begun: list[int] = []

    def fail(item: int) -> None:
        begun.append(item)
        time.sleep(0.005)
        if item == 1:
            raise KeyError(item)

    with pytest.raises(KeyError, match="1"):
        mapped(fail, range(200), workers=1, console=QUIET, describe="")
    assert len(begun) < 200
