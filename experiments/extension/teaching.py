"""Teaching the task cutting to both versions, and taking it back."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console

from experiments.framework.knowledge import added_tasks
from shared.client import Sparge
from shared.errors import NotFound, SpargeError
from shared.schemas.rule import ADD_RULE, DELETE_RULE, RuleDefinition, RuleName
from shared.schemas.task import Task, TaskDefinition

_RULES = Path(__file__).parent / "rules"


@dataclass(frozen=True)
class Lesson:
    """What is said to the backend.

    Attributes
    ----------
    task : TaskDefinition
        For Version 2: relations to affordances that exist.
    rules : tuple of RuleDefinition
        For Version 1: the conditions of Code 6.1, one rule for each kind of tool.
    """

    task: TaskDefinition
    rules: tuple[RuleDefinition, ...]

    @property
    def name(self) -> str:
        """Of the new task."""
        return self.task.name


@dataclass(frozen=True)
class Took:
    """How long the backend took to learn it, in milliseconds."""

    rules_ms: float
    task_ms: float


def lesson_on(model: Task, prefix: str) -> Lesson:
    """Return the lesson: cutting under a name that no backend knows yet.

    Parameters
    ----------
    model : Task
        The shipped task, whose relations the new one gets.
    prefix : str
        Of all new names.
    """
    task = TaskDefinition(
        name=f"{prefix}_{model.name}",
        description=model.description,
        requires=model.requires,
        grasp=model.grasp,
        avoids=model.avoids,
    )
    written = [
        RuleDefinition.model_validate_json(file.read_bytes())
        for file in sorted(_RULES.glob("*.json"))
    ]
    rules = tuple(
        rule.model_copy(update={"name": f"{prefix}_{rule.name}", "task": task.name})
        for rule in written
    )
    return Lesson(task, rules)


@contextlib.contextmanager
def taught(sparge: Sparge, console: Console, lesson: Lesson) -> Iterator[Took]:
    """Teach a backend, and let it forget the lesson in the end, also after an error."""
    added: list[str] = []
    with added_tasks(sparge, console) as tasks:
        try:
            started = time.perf_counter()
            for rule in lesson.rules:
                sparge.call(ADD_RULE, rule)
                added.append(rule.name)
            between = time.perf_counter()
            tasks.add([lesson.task])
            yield Took(1e3 * (between - started), 1e3 * (time.perf_counter() - between))
        finally:
            _forget(sparge, console, added)


def _forget(sparge: Sparge, console: Console, rules: list[str]) -> None:
    failed: SpargeError | None = None
    for name in rules:
        try:
            sparge.call(DELETE_RULE, RuleName(name=name))
        except NotFound:
            pass
        except SpargeError as error:
            console.print(f"the rule {name} is left behind: {error.message}")
            failed = failed or error
    if failed is not None:
        raise failed
