"""Tasks that a backend knows for the length of an experiment."""

from __future__ import annotations

import contextlib
import secrets
from collections.abc import Iterator, Sequence

from rich.console import Console

from experiments.framework.asking import progress_bar
from shared.client import Sparge
from shared.errors import NotFound, SpargeError
from shared.schemas.route import Nothing
from shared.schemas.task import (
    ADD_TASK,
    DELETE_TASK,
    LIST_AFFORDANCES,
    TaskDefinition,
    TaskName,
)

_SHOWN_FROM = 100
"""So many tasks and more get a progress bar."""


def name_prefix() -> str:
    """Return the beginning of a task's name that no backend has yet."""
    return f"experiment_{secrets.token_hex(4)}"


def affordances(sparge: Sparge) -> list[str]:
    """Return the names of the part affordances that a backend knows."""
    return [each.name for each in sparge.call(LIST_AFFORDANCES, Nothing()).affordances]


class AddedTasks:
    """Adds tasks through POST /tasks, and knows which ones.

    Parameters
    ----------
    sparge : Sparge
    console : Console
        For the progress of long lists.
    """

    def __init__(self, sparge: Sparge, console: Console) -> None:
        self._sparge = sparge
        self._console = console
        self._names: list[str] = []

    def add(self, definitions: Sequence[TaskDefinition]) -> None:
        """Add tasks.

        Raises
        ------
        Conflict
            The backend has a task of this name; that one is left alone.
        SpargeError
            The backend does not take it.
        """
        with progress_bar(self._console, visible=len(definitions) >= _SHOWN_FROM) as progress:
            for definition in progress.track(definitions, description="adding tasks"):
                self._sparge.call(ADD_TASK, definition)
                self._names.append(definition.name)

    def remove(self) -> None:
        """Remove what was added, and nothing else; what fails is tried, and told at the end.

        Raises
        ------
        SpargeError
            The backend would not remove a task; the first of these errors.
        """
        failed: SpargeError | None = None
        names = self._names[::-1]
        with progress_bar(self._console, visible=len(names) >= _SHOWN_FROM) as progress:
            for name in progress.track(names, description="removing tasks"):
                try:
                    self._sparge.call(DELETE_TASK, TaskName(name=name))
                except NotFound:
                    pass
                except SpargeError as error:
                    self._console.print(f"the task {name} is left behind: {error.message}")
                    failed = failed or error
        self._names.clear()
        if failed is not None:
            raise failed


@contextlib.contextmanager
def added_tasks(
    sparge: Sparge, console: Console, definitions: Sequence[TaskDefinition] = ()
) -> Iterator[AddedTasks]:
    """Give a backend tasks, and take them back in the end, also after an error."""
    tasks = AddedTasks(sparge, console)
    try:
        tasks.add(definitions)
        yield tasks
    finally:
        tasks.remove()
