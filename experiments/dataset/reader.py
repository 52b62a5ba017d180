"""Reading labelled views: our own datasets, and folders of scans in the same format."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from experiments.dataset.parse import view_from_arrays
from experiments.dataset.view import LabelledView
from shared.errors import InvalidInput, SpargeError
from shared.wire.npz import read_npz

MAX_FILE_BYTES, MAX_UNPACKED_BYTES = 2**26, 2**28


@dataclass(frozen=True)
class ViewFile:
    """Where one view is: `<folder>/<object_name>/<number>.npz`."""

    object_name: str
    number: int
    path: Path


def view_files(folder: Path) -> tuple[ViewFile, ...]:
    """Return the views in a folder, by object and number; nothing is opened.

    Raises
    ------
    InvalidInput
        The folder is missing or holds no views, or a file's name is no number.
    """
    if not folder.is_dir():
        raise InvalidInput(f"{folder} is not a folder of views")
    found = [
        ViewFile(path.parent.name, _number(path), path) for path in sorted(folder.glob("*/*.npz"))
    ]
    if not found:
        inner = [str(each) for each in sorted(folder.glob("views_*")) if each.is_dir()]
        hint = f"; it holds the folders {', '.join(inner)}" if inner else ""
        raise InvalidInput(f"no <object>/<number>.npz in {folder}{hint}")
    return tuple(sorted(found, key=lambda each: (each.object_name, each.number)))


def read_views(folder: Path) -> Iterator[LabelledView]:
    """Yield the views in a folder, by object and number, reading one at a time.

    Raises
    ------
    InvalidInput
        As `view_files` and, when it is that file's turn, `read_view`.
    """
    return (read_view(each.path) for each in view_files(folder))


def read_view(path: Path) -> LabelledView:
    """Return the view in a file `<object>/<number>.npz`.

    Raises
    ------
    InvalidInput
        It cannot be read, is no npz archive or not a view; the message names
        the file and what is wrong.
    """
    try:
        size = path.stat().st_size
        if size > MAX_FILE_BYTES:
            raise InvalidInput(f"{size} bytes, allowed are {MAX_FILE_BYTES}")
        arrays = read_npz(path.read_bytes(), MAX_UNPACKED_BYTES)
        return view_from_arrays(path.parent.name, _number(path), arrays)
    except OSError as error:
        raise InvalidInput(f"{path}: {error.strerror}", file=str(path)) from None
    except SpargeError as error:
        raise InvalidInput(f"{path}: {error.message}", file=str(path)) from None


def _number(path: Path) -> int:
    if not (path.stem.isascii() and path.stem.isdigit()):
        raise InvalidInput(f"{path}: a view's file is called <number>.npz", file=str(path))
    return int(path.stem)
