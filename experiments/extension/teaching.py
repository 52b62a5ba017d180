"""Teaching the task cutting to both versions, and taking it back."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Console

from experiments.framework.knowledge import added_tasks
from shared.client import Sparge
from shared.errors import NotFound, SpargeError
from shared.schemas.route import Route
from shared.schemas.rule import (
    ADD_AFFORDANCE,
    ADD_RULE,
    DELETE_AFFORDANCE,
    DELETE_RULE,
    AffordanceDefinition,
    AffordanceName,
    RuleBody,
    RuleDefinition,
    RuleName,
)
from shared.schemas.task import Task, TaskDefinition
from shared.wire import Message

CUT = "cut"
_RULES = Path(__file__).parent / "rules"


@dataclass(frozen=True)
class Lesson:
    """What is said to the backend.

    Attributes
    ----------
    rules : tuple of RuleDefinition
        For Version 1: the part to hold (Code 6.1), one rule for each kind of tool.
    affordance : AffordanceDefinition
        For Version 2: to cut (Code 6.3), which the other part of each rule does.
    task : TaskDefinition
        For Version 2: relations to that affordance and to shipped ones.
    """

    rules: tuple[RuleDefinition, ...]
    affordance: AffordanceDefinition
    task: TaskDefinition

    @property
    def name(self) -> str:
        """Of the new task."""
        return self.task.name


@dataclass(frozen=True)
class Took:
    """How long the backend took to learn it, in milliseconds."""

    version_1_ms: float
    version_2_ms: float


def lesson_on(model: Task, prefix: str) -> Lesson:
    """Return the lesson: cutting under names that no backend knows yet.

    Parameters
    ----------
    model : Task
        The shipped task, whose relations the new one gets; in place of the
        shipped affordance to cut it has the new one.
    prefix : str
        Of all new names.
    """
    name, cut = f"{prefix}_{model.name}", f"{prefix}_{CUT}"
    written = [
        RuleDefinition.model_validate_json(file.read_bytes())
        for file in sorted(_RULES.glob("*.json"))
    ]
    rules = tuple(
        rule.model_copy(update={"name": f"{prefix}_{rule.name}", "task": name}) for rule in written
    )
    affordance = AffordanceDefinition(
        name=cut,
        description="A thin blade for cutting material.",
        rules=tuple(_about_the_other_part(rule) for rule in rules),
    )

    def renamed(relations: Sequence[str]) -> tuple[str, ...]:
        return tuple(cut if each == CUT else each for each in relations)

    task = TaskDefinition(
        name=name,
        description=model.description,
        requires=renamed(model.requires),
        grasp=renamed(model.grasp),
        avoids=renamed(model.avoids),
    )
    return Lesson(rules, affordance, task)


@contextlib.contextmanager
def taught(sparge: Sparge, console: Console, lesson: Lesson) -> Iterator[Took]:
    """Teach a backend, and let it forget the lesson in the end, also after an error."""
    forget: list[tuple[Route[Any, Any], Message]] = []
    try:
        started = time.perf_counter()
        for rule in lesson.rules:
            sparge.call(ADD_RULE, rule)
            forget.append((DELETE_RULE, RuleName(name=rule.name)))
        between = time.perf_counter()
        sparge.call(ADD_AFFORDANCE, lesson.affordance)
        forget.append((DELETE_AFFORDANCE, AffordanceName(name=lesson.affordance.name)))
        with added_tasks(sparge, console, [lesson.task]):
            yield Took(1e3 * (between - started), 1e3 * (time.perf_counter() - between))
    finally:
        _forget(sparge, console, forget)


def _about_the_other_part(rule: RuleDefinition) -> RuleBody:
    """Return the same conditions as a rule that finds the part that `rule` does not hold."""
    (other,) = {name for each in rule.conditions for name in each.of} - {rule.part}
    return RuleBody(
        name=f"{rule.name}_{CUT}",
        description=rule.description,
        part=other,
        conditions=rule.conditions,
    )


def _forget(
    sparge: Sparge, console: Console, things: Sequence[tuple[Route[Any, Any], Message]]
) -> None:
    failed: SpargeError | None = None
    for route, thing in things:
        try:
            sparge.call(route, thing)
        except NotFound:
            pass
        except SpargeError as error:
            console.print(f"{thing} is left behind: {error.message}")
            failed = failed or error
    if failed is not None:
        raise failed
