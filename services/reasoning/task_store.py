"""Added tasks on disk: one Turtle file each, written whole or not at all."""

from __future__ import annotations

import logging
import os
import tempfile
from pathlib import Path

from services.reasoning.ontology import graph_of, read_turtle, tasks_in
from shared.errors import InternalError, StageUnavailable
from shared.schemas.task import TaskDefinition

_HEADER = "# A task that was added through the service, in the form of ontology/tasks.ttl.\n\n"
_SETTING = "SPARGE_REASONING_KNOWLEDGE_DIR"

log = logging.getLogger("sparge")


class TaskStore:
    """A folder with `<task>.ttl` for each added task.

    One file per task keeps adding cheap however many there are. A file is
    written beside its name, synced and renamed, so a crash leaves the old state
    or the new one; what is left of a half-written file is ignored.

    Parameters
    ----------
    folder : Path
        Need not exist until the first task is stored.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def read(self) -> dict[str, TaskDefinition]:
        """Return the stored tasks by name.

        Raises
        ------
        InternalError
            A file does not hold exactly the task that it is named after.
        """
        tasks: dict[str, TaskDefinition] = {}
        for file in sorted(self._folder.glob("*.ttl")):
            found = tasks_in(read_turtle(file))
            if list(found) != [file.stem]:
                raise InternalError(
                    f"{file} should hold the task {file.stem!r} alone, found {list(found)}"
                )
            tasks |= found
        return tasks

    def write(self, task: TaskDefinition) -> None:
        """Store `task` durably.

        Raises
        ------
        StageUnavailable
            The folder cannot be written.
        """
        text = _HEADER + graph_of(task).serialize(format="turtle")
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            handle, name = tempfile.mkstemp(prefix=".", suffix=".tmp", dir=self._folder)
            part = Path(name)
            try:
                with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as stream:
                    stream.write(text)
                    stream.flush()
                    os.fsync(stream.fileno())
                part.replace(self._file(task.name))
            except BaseException:
                part.unlink(missing_ok=True)
                raise
            self._sync_folder()
        except OSError as error:
            raise self._not_writable("stored", task.name, error) from error

    def remove(self, name: str) -> None:
        """Forget a stored task durably.

        Raises
        ------
        StageUnavailable
            The folder cannot be written.
        """
        try:
            self._file(name).unlink(missing_ok=True)
            self._sync_folder()
        except OSError as error:
            raise self._not_writable("deleted", name, error) from error

    def _file(self, name: str) -> Path:
        return self._folder / f"{name}.ttl"

    def _sync_folder(self) -> None:
        handle = os.open(self._folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)

    def _not_writable(self, action: str, name: str, error: OSError) -> StageUnavailable:
        log.error("knowledge folder %s: %s", self._folder, error)
        return StageUnavailable(
            f"the task {name!r} cannot be {action}: the knowledge folder is not writable "
            f"({error.strerror}); set {_SETTING} to one that is",
            stage="reasoning",
            setting=_SETTING,
        )
