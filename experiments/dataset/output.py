"""The folder that a dataset is written to: one writer at a time, whole files only."""

from __future__ import annotations

import contextlib
import fcntl
import os
from collections.abc import Iterator
from pathlib import Path

from experiments.dataset import manifest as manifests
from shared.errors import Conflict, InvalidInput

CLEAN, NOISY = "views_clean", "views_noisy"
LOCK = ".lock"
_UNFINISHED = ".part"


@contextlib.contextmanager
def claimed(folder: Path) -> Iterator[None]:
    """Own a dataset's folder, made where it is missing.

    A killed owner's claim ends with it; what it left half-written is removed.

    Raises
    ------
    InvalidInput
        It cannot be made or written to, or holds files that are not a dataset.
    Conflict
        Another process is writing to it.
    """
    if folder.is_file():
        raise InvalidInput(f"{folder} is a file; name a folder")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not (folder / manifests.NAME).exists():
            strangers = sorted(each.name for each in folder.iterdir() if not _ours(each.name))
            if strangers:
                raise InvalidInput(
                    f"{folder} holds {strangers[0]!r} and no dataset; name a new or empty folder"
                )
        lock = (folder / LOCK).open("wb")
    except OSError as error:
        raise _unusable(folder, error) from None
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Conflict(f"another process is writing to {folder}") from None
        for path in (*folder.glob(f".*{_UNFINISHED}"), *folder.glob(f"*/*/.*{_UNFINISHED}")):
            path.unlink()
        yield


def write_whole(path: Path, content: bytes) -> None:
    """Write a file that is either not there or whole, making its folder.

    Raises
    ------
    InvalidInput
        The system refuses: no right, no space.
    """
    unfinished = path.with_name(f".{path.name}{_UNFINISHED}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with unfinished.open("wb") as stream:
            stream.write(content)
            stream.flush()
            os.fsync(stream.fileno())
        unfinished.replace(path)
    except OSError as error:
        raise _unusable(path, error) from None


def _unusable(path: Path, error: OSError) -> InvalidInput:
    return InvalidInput(f"cannot write to {path}: {error.strerror or error}", path=str(path))


def _ours(name: str) -> bool:
    return name == LOCK or (name.startswith(".") and name.endswith(_UNFINISHED))
