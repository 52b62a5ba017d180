"""How long a decision takes, with little and with much knowledge."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.reasoning.change import Change
from services.reasoning.contact import touching
from services.reasoning.reasoner import Reasoner
from shared.schemas.primitive import Joint, Primitive
from shared.schemas.rule import AffordanceDefinition, RuleDefinition
from shared.schemas.task import Affordance, DecideRequest, RuleSet, TaskDefinition, Version
from tests.services.reasoning.objects import BOTTLE, HAMMER, KNIFE, LADLE, PAN, TURNER

TASKS = ("cooking", "cutting", "hammering", "handover", "pouring", "scooping", "turning")
VERSIONS: tuple[Version, ...] = ("v1", "v2")
FOUR_PARTS = (*PAN, *(each.model_copy(update={"id": each.id + 2}) for each in HAMMER))
OBJECTS = (PAN, BOTTLE, HAMMER, LADLE, TURNER, KNIFE, FOUR_PARTS)
RULE_SETS: tuple[RuleSet, ...] = ("thesis", "default")
ADDED_TASKS, ADDED_AFFORDANCES = 993, 200


@dataclass(frozen=True)
class Taken:
    """Processor time of decisions of one kind, (N,) milliseconds."""

    what: str
    times: NDArray[np.float64]

    def percentile(self, share: float) -> float:
        return float(np.percentile(self.times, share))

    def line(self) -> str:
        """Return it as a line of a table."""
        return (
            f"{self.what:54} {len(self.times):5d} {self.percentile(50):9.2f} "
            f"{self.percentile(95):9.2f} {self.percentile(99):9.2f}"
        )


HEADER = (
    f"{'decisions, with proof; processor time':54} {'count':>5} "
    f"{'p50 ms':>9} {'p95 ms':>9} {'p99 ms':>9}"
)


def question(
    task: str, version: Version, primitives: tuple[Primitive, ...], rule_set: RuleSet
) -> DecideRequest:
    """Return the question as the gateway asks it: with the joints that the recovery knows."""
    joints = tuple(
        Joint(primitive_ids=(primitives[one].id, primitives[other].id), position=(0.0, 0.0, 0.0))
        for one, other in touching(primitives, ())
    )
    return DecideRequest(
        task=task, reasoning=version, primitives=primitives, joints=joints, rule_set=rule_set
    )


def milliseconds(
    decide: Callable[[DecideRequest], object],
    tasks: Sequence[str],
    rule_set: RuleSet,
    versions: Sequence[Version] = VERSIONS,
    objects: Sequence[tuple[Primitive, ...]] = OBJECTS,
) -> NDArray[np.float64]:
    """Return what every question takes, processor time of the whole process."""
    taken = []
    for task, version, primitives in itertools.product(tasks, versions, objects):
        request = question(task, version, primitives, rule_set)
        begin = time.process_time()
        decide(request)
        taken.append(1e3 * (time.process_time() - begin))
    return np.array(taken)


def speeds(reasoner: Reasoner, rounds: int = 1) -> Iterator[Taken]:
    """Yield the times with the shipped knowledge, then with 1,000 tasks and 207 affordances.

    Parameters
    ----------
    reasoner : Reasoner
        Warm, and with nothing learned.
    rounds : int
        How often every question is asked.
    """

    def asked(what: str, tasks: Sequence[str], rule_set: RuleSet) -> Taken:
        versions = VERSIONS if tasks == TASKS else ("v2",)
        return Taken(
            f"{rule_set}, {what}",
            np.concatenate(
                [milliseconds(reasoner.decide, tasks, rule_set, versions) for _ in range(rounds)]
            ),
        )

    for rule_set in RULE_SETS:
        milliseconds(reasoner.decide, TASKS, rule_set)  # the first one of each compiles
        yield asked("7 tasks", TASKS, rule_set)
    learned = learn_a_lot(reasoner)
    much = "1000 tasks, 207 affordances"
    for rule_set in RULE_SETS:
        yield asked(f"{much}, shipped tasks", TASKS, rule_set)
        yield asked(f"{much}, learned tasks", learned, rule_set)


def learned_affordance(number: int) -> AffordanceDefinition:
    """Return one that many parts have, so that its rule cannot be dismissed at once."""
    conditions = [
        {"condition": "min_dimension", "value": [0.001, 0.01, 0.02]},
        {"condition": "max_dimension", "value": [0.2, 0.3, 1 + number / 1000]},
        {"condition": "min_ratio", "value": 1 + number / 100},
        {"condition": "shape", "value": ["cuboid", "cylinder"]},
    ]
    return AffordanceDefinition.model_validate(
        {"name": f"use_{number}", "rules": [{"name": f"rule_{number}", "conditions": conditions}]}
    )


def learn_a_lot(reasoner: Reasoner) -> list[str]:
    """Add 200 affordances and 993 tasks in one step; return some of the tasks."""
    affordances = [learned_affordance(number) for number in range(ADDED_AFFORDANCES)]
    tasks = []
    for number in range(ADDED_TASKS):
        uses = (f"use_{number % 200}", f"use_{(7 * number + 1) % 200}")
        tasks.append(TaskDefinition(name=f"task_{number}", requires=uses, grasp=("grasp", *uses)))
    change = Change(
        tasks=tuple(tasks),
        affordances=tuple(Affordance(name=a.name, description="") for a in affordances),
        rules=tuple(RuleDefinition(**dict(a.rules[0]), affordance=a.name) for a in affordances),
    )
    reasoner._warm().knowledge._memory.change(change)
    return [task.name for task in tasks[::100]]
