"""The backend that a worker asks: the whole of it in the worker's own process."""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any, Protocol

import orjson

from services.annotate.question import Question
from shared.client import GraspResult, Sparge
from shared.errors import EmptyCloud
from shared.schemas.grasp import LIST_GRIPPERS
from shared.schemas.route import Nothing, Route
from shared.schemas.rule import LIST_RULES
from shared.schemas.task import LIST_AFFORDANCES, LIST_TASKS

READY_TIMEOUT_S = 900.0
"""A first start compiles the kernels, perhaps beside other workers that do the same."""
_TAUGHT: tuple[Route[Nothing, Any], ...] = (LIST_TASKS, LIST_AFFORDANCES, LIST_RULES, LIST_GRIPPERS)
_KNOWLEDGE_DIR = "SPARGE_REASONING_KNOWLEDGE_DIR"


class Pipeline(Protocol):
    """What answers; `EmbeddedPipeline` but in tests."""

    def check(self, question: Question) -> str:
        """Return a digest of what decides the answers beside question and file.

        Raises
        ------
        SpargeError
            The question itself cannot be asked: an unknown task, a wrong parameter.
        """

    def grasp_file(self, name: str, data: bytes, task: str, **parameters: Any) -> GraspResult:
        """As `shared.client.Sparge.grasp_file`."""


StartPipeline = Callable[[], AbstractContextManager[Pipeline]]
"""Starts the pipeline of a worker; sent to every worker, so it must be importable there."""


@dataclass(frozen=True)
class EmbeddedPipeline:
    """The embedded backend, through its public contract."""

    sparge: Sparge

    def check(self, question: Question) -> str:
        for task in question.tasks:
            self._check(task, question.parameters)
        taught = [self.sparge.call(route, Nothing()).model_dump(mode="json") for route in _TAUGHT]
        told = {
            name: value
            for name, value in os.environ.items()
            if name.startswith("SPARGE_") and name != _KNOWLEDGE_DIR  # what it holds is `taught`
        }
        known = orjson.dumps([taught, told], option=orjson.OPT_SORT_KEYS)
        return hashlib.sha256(known).hexdigest()

    def _check(self, task: str, parameters: dict[str, Any]) -> None:
        """Ask about nothing: the backend minds the names and values before it minds the points."""
        of_a_file = ("intrinsics", "depth_scale")
        asked = {name: value for name, value in parameters.items() if name not in of_a_file}
        with contextlib.suppress(EmptyCloud):
            self.sparge.grasp({"points": [[0.0, 0.0, 1.0]]}, task, **asked)

    def grasp_file(self, name: str, data: bytes, task: str, **parameters: Any) -> GraspResult:
        return self.sparge.grasp_file(name, data, task, **parameters)


@contextlib.contextmanager
def start_embedded() -> Iterator[Pipeline]:
    """Run the whole backend in this process."""
    from services.wiring import embedded

    with embedded(READY_TIMEOUT_S) as sparge:
        yield EmbeddedPipeline(sparge)
