"""How long a decision takes; `pytest -s` shows the figures.

The thesis reports 150 to 250 ms for its reasoning. The bounds here are loose, for
machines that are busy with something else.
"""

from __future__ import annotations

import itertools
import time

import numpy as np

from services.reasoning.reasoner import Reasoner
from shared.schemas.task import DecideRequest, TaskDefinition, Version
from tests.services.reasoning.objects import BOTTLE, HAMMER, KNIFE, LADLE, PAN, TURNER

TASKS = ("cooking", "cutting", "hammering", "handover", "pouring", "scooping", "turning")
VERSIONS: tuple[Version, ...] = ("v1", "v2")
FOUR_PARTS = (*PAN, *(each.model_copy(update={"id": each.id + 2}) for each in HAMMER))


def milliseconds(reasoner: Reasoner) -> np.ndarray:
    taken = []
    objects = (PAN, BOTTLE, HAMMER, LADLE, TURNER, KNIFE, FOUR_PARTS)
    for task, version, primitives in itertools.product(TASKS, VERSIONS, objects):
        request = DecideRequest(task=task, reasoning=version, primitives=primitives)
        for _ in range(3):
            begin = time.perf_counter()
            reasoner.decide(request)
            taken.append(1e3 * (time.perf_counter() - begin))
    return np.array(taken)


def test_a_decision_takes_milliseconds_however_many_tasks_are_known(reasoner: Reasoner) -> None:
    for added in (0, 1000):
        for number in range(added):
            reasoner.add_task(TaskDefinition(name=f"task_{number}", grasp=("grasp", "support")))
        p50, p95 = np.percentile(milliseconds(reasoner), [50, 95])
        print(f"\ndecide with {7 + added} tasks: p50 {p50:.2f} ms, p95 {p95:.2f} ms", end="")
        assert p95 < 20
