"""The folder that a dataset is written to: nothing but a dataset is ever touched."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

from experiments.dataset import manifest as manifests
from shared.errors import InvalidInput
from shared.output import LOCK, UNFINISHED, sole_writer, unusable

CLEAN, NOISY = "views_clean", "views_noisy"


@contextlib.contextmanager
def claimed(folder: Path) -> Iterator[None]:
    """Own a dataset's folder, made where it is missing.

    Raises
    ------
    InvalidInput
        It cannot be made or written to, or holds files that are not a dataset.
    Conflict
        Another process is writing to it.
    """
    try:
        if folder.is_dir() and not (folder / manifests.NAME).exists():
            strangers = sorted(each.name for each in folder.iterdir() if not _ours(each.name))
            if strangers:
                raise InvalidInput(
                    f"{folder} holds {strangers[0]!r} and no dataset; name a new or empty folder"
                )
    except OSError as error:
        raise unusable(folder, error) from None
    with sole_writer(folder):
        yield


def _ours(name: str) -> bool:
    return name == LOCK or (name.startswith(".") and name.endswith(UNFINISHED))
