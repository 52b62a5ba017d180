"""Timing requests, one at a time."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

from experiments.framework import Context
from experiments.framework.asking import NOT_THE_VIEW, VERSIONS, progress_bar
from experiments.timing.cases import Case
from shared.client import Sparge
from shared.errors import SpargeError
from shared.schemas.route import Nothing
from shared.schemas.task import LIST_TASKS, Version

COMPARABLE = ("primitive_recovery", "reasoning", "matching")
"""Our stages that do what the thesis's total covers: no perception, no grasp detection."""
CHECKS = "checks"
STAGES = (
    ("parsing", "parsing the body", ()),
    (CHECKS, "checking the names, beside perception", ()),
    ("perception", "perception", ()),
    (
        "primitive_recovery",
        "primitive recovery",
        ("superquadrics", "overlap removal", "shape classification"),
    ),
    ("reasoning", "reasoning", ("reasoning",)),
    ("matching", "matching", ("point cloud segmentation",)),
    ("grasp_proposal", "grasp proposal", ()),
)


@dataclass(frozen=True)
class Timed:
    """What one request took, in seconds.

    Attributes
    ----------
    tasks : int
        How many tasks the backend knew.
    task, class_name, reasoning : str
    stages : mapping
        As the backend measured them.
    seen : float
        From the client's call to its answer.
    """

    tasks: int
    task: str
    class_name: str
    reasoning: str
    stages: dict[str, float]
    seen: float

    @property
    def total(self) -> float:
        """The whole request, as the backend measured it."""
        return self.stages["total"]

    @property
    def rest(self) -> float:
        """What no stage accounts for: the chain itself. The checks run beside perception."""
        spent = (self.stages.get(stage, 0.0) for stage, *_ in STAGES if stage != CHECKS)
        return self.total - sum(spent)

    @property
    def way(self) -> float:
        """What only the client sees: packing the view, HTTP, writing and unpacking the answer."""
        return self.seen - self.total

    @property
    def reasoning_stage(self) -> float:
        """The stage that knows the tasks."""
        return self.stages.get("reasoning", 0.0)

    @property
    def comparable(self) -> float:
        """What the thesis's total covers."""
        return sum(self.stages.get(stage, 0.0) for stage in COMPARABLE)

    def record(self) -> dict[str, str]:
        """Return it as a line of a CSV file, in milliseconds."""
        return {
            "tasks": str(self.tasks),
            "task": self.task,
            "class": self.class_name,
            "reasoning": self.reasoning,
            **{stage: f"{1e3 * self.stages.get(stage, 0.0):.2f}" for stage, *_ in STAGES},
            "comparable": f"{1e3 * self.comparable:.2f}",
            "total": f"{1e3 * self.total:.2f}",
            "seen": f"{1e3 * self.seen:.2f}",
        }


def measure(context: Context, cases: Sequence[Case], tasks: int, describe: str) -> list[Timed]:
    """Ask one at a time, the versions in turns."""
    timed: list[Timed | None] = []
    with progress_bar(context.console) as progress:
        for case in progress.track(cases, description=describe):
            timed += [_time(context.sparge, case, version, tasks) for version in VERSIONS]
    return [each for each in timed if each is not None]


def _time(sparge: Sparge, case: Case, version: Version, tasks: int) -> Timed | None:
    """Return what a request takes; None where the view is refused."""
    arrays = case.view.arrays()
    started = time.perf_counter()
    try:
        result = sparge.grasp(arrays, case.task, reasoning=version)
    except NOT_THE_VIEW:
        raise
    except SpargeError:
        return None
    seen = time.perf_counter() - started
    stages = {name: 1e-3 * spent for name, spent in result.answer.timings_ms.items()}
    return Timed(tasks, case.task, case.class_name, version, stages, seen)


def of_version(timed: Sequence[Timed], version: str) -> list[Timed]:
    """Return the requests to one version."""
    return [each for each in timed if each.reasoning == version]


def counts_of(timed: Sequence[Timed]) -> list[int]:
    """Return the numbers of tasks that were timed, ascending."""
    return sorted({each.tasks for each in timed})


def time_listing(sparge: Sparge, repeat: int = 3) -> float:
    """Return the median seconds of GET /tasks."""
    spent = []
    for _ in range(repeat):
        started = time.perf_counter()
        sparge.call(LIST_TASKS, Nothing())
        spent.append(time.perf_counter() - started)
    return median(spent)
