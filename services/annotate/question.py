"""What is asked about every file, and what an answer depends on."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import orjson

from shared import __version__


@dataclass(frozen=True)
class Question:
    """The tasks, and the parameters of POST /grasp that are the same for all files.

    Attributes
    ----------
    tasks : tuple of str
        In lower case, without repetition.
    parameters : dict
        By the contract's names; JSON values.
    """

    tasks: tuple[str, ...]
    parameters: dict[str, Any]

    @cached_property
    def settings(self) -> str:
        """The parameters as JSON, the same text for the same parameters."""
        return orjson.dumps(self.parameters, option=orjson.OPT_SORT_KEYS).decode()


@dataclass(frozen=True)
class Terms:
    """Beside file and task, all that decides an answer; rows of other terms are out of date.

    Attributes
    ----------
    settings : str
        `Question.settings`.
    backend : str
        Digest of what the backend was taught and told (`Pipeline.check`).
    version : str
        Of SPaRGE.
    """

    settings: str
    backend: str
    version: str = __version__


@dataclass(frozen=True)
class Job:
    """One file asked about for one task: what a worker gets.

    Attributes
    ----------
    path : str
        Relative to the input folder.
    task : str
    sha256 : str
        Of the file, hexadecimal.
    data : bytes
        The file.
    """

    path: str
    task: str
    sha256: str
    data: bytes

    @property
    def key(self) -> tuple[str, str]:
        """What is answered once: path and task."""
        return self.path, self.task


@dataclass(frozen=True)
class Refusal:
    """Why a file has no row for a task.

    Attributes
    ----------
    code, message : str
        As in the contract's errors, or a code of docs/annotate.md.
    passing : bool
        The file need not be to blame, so it is worth asking again.
    """

    code: str
    message: str
    passing: bool = False
