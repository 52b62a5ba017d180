"""Many requests to one reasoner, and what its process needs meanwhile."""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from services.reasoning.reasoner import Reasoner
from shared.schemas.task import DecideRequest, TaskDefinition, TaskName
from tests.bench.speed import OBJECTS, RULE_SETS, TASKS, VERSIONS, question

WINDOWS = 20
TEACH_EVERY = 500
"""So many requests from one task that is taught, asked for and forgotten to the next."""
FLAT = 0.02
"""Growth of the memory over the second half that counts as none, as a share."""
_STATUS = Path("/proc/self/status")


@dataclass(frozen=True)
class Window:
    """A stretch of requests.

    Attributes
    ----------
    requests : int
        How many were answered until its end.
    rss_mb : float
        Resident memory of the process then, 10^6 bytes.
    p50, p95, p99 : float
        Processor time of a request in it, milliseconds.
    """

    requests: int
    rss_mb: float
    p50: float
    p95: float
    p99: float

    def line(self) -> str:
        """Return it as a line of a table."""
        return (
            f"{self.requests:>9,d} {self.rss_mb:9.1f} "
            f"{self.p50:9.2f} {self.p95:9.2f} {self.p99:9.2f}"
        )


HEADER = f"{'requests':>9} {'RSS MB':>9} {'p50 ms':>9} {'p95 ms':>9} {'p99 ms':>9}"


def soak(reasoner: Reasoner, requests: int) -> Iterator[Window]:
    """Ask for decisions with proof: every object, task, version and rule set in turn.

    Every `TEACH_EVERY` requests a task is taught, asked for and forgotten.
    """
    questions = itertools.cycle(
        [
            question(task, version, parts, rule_set)
            for task, version, parts, rule_set in itertools.product(
                TASKS, VERSIONS, OBJECTS, RULE_SETS
            )
        ]
    )
    ends = {round(requests * (k + 1) / WINDOWS) for k in range(WINDOWS)}
    taken: list[float] = []
    for number in range(1, requests + 1):
        begin = time.process_time()
        reasoner.decide(next(questions))
        taken.append(1e3 * (time.process_time() - begin))
        if number % TEACH_EVERY == 0:
            _teach_and_forget(reasoner, number)
        if number in ends:
            p50, p95, p99 = np.percentile(taken, [50, 95, 99])
            yield Window(number, resident_mb(), float(p50), float(p95), float(p99))
            taken.clear()


def growth(windows: list[Window]) -> float:
    """Return by which share the memory grew from the middle to the end, by a straight line."""
    half = windows[len(windows) // 2 - 1 :]
    number = np.array([each.requests for each in half], dtype=np.float64)
    rss = np.array([each.rss_mb for each in half])
    slope = float(np.polyfit(number, rss, 1)[0])
    return slope * float(number[-1] - number[0]) / float(rss[0])


def resident_mb() -> float:
    """Return the resident memory of this process in 10^6 bytes; Linux."""
    line = next(each for each in _STATUS.read_text().splitlines() if each.startswith("VmRSS"))
    return int(line.split()[1]) * 1024 / 1e6


def _teach_and_forget(reasoner: Reasoner, number: int) -> None:
    name = f"soak_{number}"
    reasoner.add_task(TaskDefinition(name=name, requires=("contain",), grasp=("wrap_grasp",)))
    reasoner.decide(DecideRequest(task=name, primitives=OBJECTS[1]))
    reasoner.delete_task(TaskName(name=name))
