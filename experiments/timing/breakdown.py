"""Where the milliseconds of a request go, over all objects and tasks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from experiments.framework import Table
from experiments.framework.cells import Cell
from experiments.timing.measure import STAGES, Timed


def breakdown_table(timed: Mapping[str, Sequence[Timed]]) -> Table:
    """Return one line for each set of views and stage, what no stage accounts for included.

    Parameters
    ----------
    timed : mapping
        Name of a set of views -> its requests. Sets without any are left out.
    """
    rows: list[tuple[Cell, ...]] = []
    for source, requests in timed.items():
        total = sum(each.total for each in requests)
        rows += [
            (source, name, len(seconds), *_middle_and_high(seconds), 100 * sum(seconds) / total)
            for name, seconds in _lines(requests).items()
            if seconds
        ]
    return Table(
        "breakdown",
        "Where the milliseconds go: every object, every task, both versions",
        ("views", "stage", "requests", "median ms", "p95 ms", "% of all time"),
        tuple(rows),
        "One request at a time. Stages are measured at the gateway, so they hold the way there and "
        "back: encoding, ASGI or network, decoding. Grasp proposal is left out where no part is "
        "found. Whether task and gripper are known is asked while perception works; the rest is "
        "what no other stage accounts for. Client: what only it sees, which is packing the view, "
        "HTTP, and writing and unpacking the answer.",
    )


def _lines(requests: Sequence[Timed]) -> dict[str, list[float]]:
    lines = {
        name: [each.stages[stage] for each in requests if stage in each.stages]
        for stage, name, _ in STAGES
    }
    lines["rest of the gateway"] = [each.rest for each in requests]
    lines["whole request, backend"] = [each.total for each in requests]
    lines["client, on top"] = [each.way for each in requests]
    return lines


def _middle_and_high(seconds: Sequence[float]) -> tuple[float, float]:
    middle, high = np.percentile(1e3 * np.asarray(seconds), [50, 95])
    return float(middle), float(high)
