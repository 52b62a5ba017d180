"""Writing a folder so that it survives interruptions: one writer at a time, whole files only."""

from __future__ import annotations

import contextlib
import fcntl
import os
from collections.abc import Iterator
from pathlib import Path

from shared.errors import Conflict, InvalidInput

LOCK = ".lock"
UNFINISHED = ".part"
"""Suffix of a file that is being written; its name begins with a dot as well."""


@contextlib.contextmanager
def sole_writer(folder: Path) -> Iterator[None]:
    """Be the only one to write to a folder, made where it is missing.

    A killed writer's claim ends with it; what it left half-written is removed.

    Raises
    ------
    InvalidInput
        It cannot be made or written to.
    Conflict
        Another process is writing to it.
    """
    if folder.is_file():
        raise InvalidInput(f"{folder} is a file; name a folder")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock = (folder / LOCK).open("wb")
    except OSError as error:
        raise unusable(folder, error) from None
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Conflict(f"another process is writing to {folder}") from None
        for path in folder.rglob(f".*{UNFINISHED}"):
            path.unlink()
        yield


def write_whole(path: Path, content: bytes | memoryview) -> None:
    """Write a file that is either not there (or as it was) or whole, making its folder.

    Raises
    ------
    InvalidInput
        The system refuses: no right, no space.
    """
    unfinished = path.with_name(f".{path.name}{UNFINISHED}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with unfinished.open("wb") as stream:
            stream.write(content)
            stream.flush()
            os.fsync(stream.fileno())
        unfinished.replace(path)
    except OSError as error:
        raise unusable(path, error) from None


def unusable(path: Path, error: OSError) -> InvalidInput:
    """Return the error of a path that the system does not let us write."""
    return InvalidInput(f"cannot write to {path}: {error.strerror or error}", path=str(path))
