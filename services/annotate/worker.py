"""A worker: one process with one pipeline, asked one thing at a time."""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import ExitStack
from typing import Any

from services.annotate.label import label
from services.annotate.pipeline import StartPipeline
from services.annotate.question import Job, Question, Terms


class Worker:
    """Becomes a Ray actor; Ray runs its methods one after the other.

    Parameters
    ----------
    start : callable
        Starts the pipeline.
    question : Question
    environment : mapping
        The driver's settings of the backend, so that all workers have the same.
    """

    def __init__(
        self, start: StartPipeline, question: Question, environment: Mapping[str, str]
    ) -> None:
        os.environ.update(environment)
        self._start, self._question = start, question
        self._running = ExitStack()  # ends with the process

    def start(self) -> Terms:
        """Start the pipeline; return what its answers depend on beside file and task.

        Raises
        ------
        SpargeError
            It cannot be started, or the question not be asked.
        """
        self._pipeline = self._running.enter_context(self._start())
        self._terms = Terms(self._question.settings, self._pipeline.check(self._question))
        return self._terms

    def ask(self, job: Job) -> Any:
        """Return the row or the `Refusal` of a job."""
        return label(self._pipeline, job, self._question.parameters, self._terms)
