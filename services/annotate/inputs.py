"""The files of a folder, in an order that does not change, and their bytes."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from services.annotate.question import Refusal
from shared.errors import InvalidInput
from shared.wire.files import EXTENSIONS


@dataclass(frozen=True)
class InputFile:
    """A file as it was read once.

    Attributes
    ----------
    sha256 : str
        Of the bytes, hexadecimal.
    data : bytes
    """

    sha256: str
    data: bytes


def find_inputs(folder: Path) -> list[Path]:
    """Return the clouds and depth images below `folder`, ordered by their names.

    Hidden files and folders are left out, and links to folders not followed.

    Raises
    ------
    InvalidInput
        There is no such folder, or it cannot be read.
    """
    try:
        return sorted(_walk(folder), key=lambda path: path.relative_to(folder).parts)
    except OSError as error:
        raise InvalidInput(f"cannot read {folder}: {error.strerror or error}") from None


def _walk(folder: Path) -> Iterator[Path]:
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.name.startswith("."):
                continue
            if entry.is_dir(follow_symlinks=False):
                yield from _walk(Path(entry.path))
            elif entry.name.lower().endswith(EXTENSIONS) and _is_file_or_gone(entry):
                yield Path(entry.path)


def _is_file_or_gone(entry: os.DirEntry[str]) -> bool:
    """Leave out pipes and sockets; a link that leads nowhere was meant to be a file."""
    return entry.is_file() or (entry.is_symlink() and not Path(entry.path).exists())


def name_of(path: Path, folder: Path) -> str:
    """Return the path below `folder` as text, with `/`; bytes that are no UTF-8 are escaped."""
    relative = path.relative_to(folder).as_posix()
    return os.fsencode(relative).decode("utf-8", "backslashreplace")


def read_input(path: Path, max_bytes: int) -> InputFile | Refusal:
    """Return a file's bytes, or why they cannot be had."""
    try:
        with path.open("rb") as stream:
            data = stream.read(max_bytes + 1)
    except OSError as error:
        return Refusal("unreadable", f"cannot be read: {error.strerror or error}")
    if len(data) > max_bytes:
        return Refusal("too_large", f"holds more than the {max_bytes} bytes that are accepted")
    return InputFile(hashlib.sha256(data).hexdigest(), data)
