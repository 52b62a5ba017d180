"""Tasks for the length of an experiment."""

from __future__ import annotations

import pytest
from rich.console import Console

from experiments.framework.knowledge import added_tasks, affordances, name_prefix
from shared.client import Sparge
from shared.errors import Conflict
from shared.schemas.route import Nothing
from shared.schemas.task import ADD_TASK, DELETE_TASK, LIST_TASKS, TaskDefinition, TaskName

QUIET = Console(quiet=True)


def names(sparge: Sparge) -> set[str]:
    return {task.name for task in sparge.call(LIST_TASKS, Nothing()).tasks}


def new_tasks(count: int) -> list[TaskDefinition]:
    prefix = name_prefix()
    return [TaskDefinition(name=f"{prefix}_{k}", grasp=("grasp",)) for k in range(count)]


def test_tasks_go_when_the_experiment_fails(sparge: Sparge) -> None:
    before, tasks = names(sparge), new_tasks(3)

    def fail() -> None:
        with added_tasks(sparge, QUIET, tasks) as added:
            added.add(new_tasks(1))
            assert len(names(sparge)) == len(before) + 4
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert names(sparge) == before


def test_a_task_that_was_there_before_is_left_alone(sparge: Sparge) -> None:
    (own,) = new_tasks(1)
    sparge.call(ADD_TASK, own)
    try:
        with pytest.raises(Conflict), added_tasks(sparge, QUIET, [*new_tasks(2), own]):
            pytest.fail("a task was added twice")
        assert own.name in names(sparge)
    finally:
        sparge.call(DELETE_TASK, TaskName(name=own.name))


def test_a_task_that_someone_else_removed_is_no_error(sparge: Sparge) -> None:
    before, tasks = names(sparge), new_tasks(2)
    with added_tasks(sparge, QUIET, tasks):
        sparge.call(DELETE_TASK, TaskName(name=tasks[0].name))
    assert names(sparge) == before


def test_prefixes_do_not_repeat() -> None:
    assert len({name_prefix() for _ in range(100)}) == 100


def test_the_affordances_are_those_of_the_backend(sparge: Sparge) -> None:
    assert {"grasp", "cut", "contain"} <= set(affordances(sparge))
