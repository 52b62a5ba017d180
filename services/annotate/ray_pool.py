"""Workers as Ray actors. One that dies, hangs or fails is replaced, its job comes back."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from types import TracebackType
from typing import Any, Self

import ray
from ray.exceptions import RayActorError, RayError, RayTaskError

from services.annotate.pipeline import READY_TIMEOUT_S, StartPipeline
from services.annotate.pool import Finished
from services.annotate.question import Job, Question, Refusal, Terms
from services.annotate.worker import Worker
from shared.errors import Conflict, SpargeError, StageUnavailable

START_TIMEOUT_S = READY_TIMEOUT_S + 60.0
_POLL_S = 1.0


@dataclass
class _Busy:
    """An actor at work: on a job, or on getting ready (`job` is None)."""

    actor: Any
    job: Job | None
    since: float = field(default_factory=time.monotonic)


class RayPool:
    """As `services.annotate.pool.WorkerPool`, on the cluster that Ray is connected to.

    A first worker is started alone: it says whether the question can be asked, and leaves
    compiled kernels behind for the others.

    Parameters
    ----------
    size : int
        Workers; each takes one of Ray's CPUs.
    start : callable
        Starts a worker's pipeline.
    question : Question
    environment : mapping
        Settings of the backend, for all workers.
    patience_s : float
        A worker that takes longer for a job is killed.
    """

    def __init__(
        self,
        size: int,
        start: StartPipeline,
        question: Question,
        environment: Mapping[str, str],
        patience_s: float,
    ) -> None:
        self._size, self._patience_s = size, patience_s
        self._make = ray.remote(
            num_cpus=1,  # Ray tells OpenMP and BLAS of it as well
            max_restarts=0,  # we replace them ourselves, and know on which job one died
            max_task_retries=0,
        )(Worker).remote
        self._arguments = (start, question, dict(environment))
        self._idle: list[Any] = []
        self._busy: dict[Any, _Busy] = {}
        self._terms: Terms | None = None
        self._failed_starts = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        for actor in [*self._idle, *(each.actor for each in self._busy.values())]:
            _end(actor)

    def start(self) -> Terms:
        """Start the workers; return what their answers depend on, once the first is ready.

        Raises
        ------
        SpargeError
            The question cannot be asked, or no worker can be started.
        """
        self._hire()
        while self._terms is None:
            self.take()
        for _ in range(self._size - 1):
            self._hire()
        return self._terms

    @property
    def idle(self) -> int:
        return len(self._idle)

    @property
    def ready(self) -> int:
        """How many workers have started: idle or at work."""
        return len(self._idle) + sum(each.job is not None for each in self._busy.values())

    def give(self, job: Job) -> None:
        actor = self._idle.pop()
        self._busy[actor.ask.remote(job)] = _Busy(actor, job)

    def take(self) -> Sequence[Finished]:
        refs = list(self._busy)
        ready, _ = ray.wait(refs, num_returns=1, timeout=_POLL_S)
        if ready:  # and whatever else is ready by now
            ready, _ = ray.wait(refs, num_returns=len(refs), timeout=0)
        finished = [self._finish(ref, self._busy.pop(ref)) for ref in ready]
        self._check_starts()
        finished += [self._give_up(ref) for ref in self._overdue()]
        return [each for each in finished if each is not None]

    def _hire(self) -> None:
        actor = self._make(*self._arguments)
        self._busy[actor.start.remote()] = _Busy(actor, None)

    def _finish(self, ref: Any, busy: _Busy) -> Finished | None:
        try:
            result = ray.get(ref)
        except RayError as error:
            return self._replace(busy, error)
        if busy.job is None:
            self._agree(result)
            self._failed_starts = 0
            self._idle.append(busy.actor)
            return None
        if isinstance(result, Refusal) and result.passing:
            # What it could not finish may still be at work in it.
            _end(busy.actor)
            self._hire()
        else:
            self._idle.append(busy.actor)
        return Finished(busy.job, result)

    def _agree(self, terms: Terms) -> None:
        """Check that a worker answers as the others do."""
        if self._terms is None:
            self._terms = terms
        elif terms != self._terms:
            differing = [
                name for name in vars(terms) if vars(terms)[name] != vars(self._terms)[name]
            ]
            raise Conflict(
                f"the workers do not agree on {', '.join(differing)}: install the same version "
                "and the same knowledge on every node"
            )

    def _replace(self, busy: _Busy, error: Exception) -> Finished | None:
        _end(busy.actor)
        if busy.job is None:
            self._start_failed(error)
        self._hire()
        if busy.job is None:
            return None
        why = "its worker died" if isinstance(error, RayActorError) else "its worker failed"
        return Finished(busy.job, Refusal("worker_died", f"{why}: {_first_line(error)}", True))

    def _start_failed(self, error: Exception) -> None:
        cause = error.cause if isinstance(error, RayTaskError) else error
        if isinstance(cause, SpargeError) and not isinstance(cause, StageUnavailable):
            raise cause  # the question cannot be asked
        self._failed_starts += 1
        if self._failed_starts > self._size + 2:  # a node may take a few with it
            raise StageUnavailable(f"no worker can be started: {_first_line(cause)}")

    def _check_starts(self) -> None:
        """Do not wait forever for the only workers that there could be."""
        waited = [time.monotonic() - each.since for each in self._busy.values() if not each.job]
        all_start = not self._idle and len(waited) == len(self._busy) > 0
        if all_start and min(waited) > START_TIMEOUT_S:
            raise StageUnavailable(
                f"no worker became ready within {START_TIMEOUT_S:g} s; are there CPUs to spare?"
            )

    def _overdue(self) -> list[Any]:
        now = time.monotonic()
        return [
            ref
            for ref, busy in self._busy.items()
            if busy.job is not None and now - busy.since > self._patience_s
        ]

    def _give_up(self, ref: Any) -> Finished | None:
        busy = self._busy.pop(ref)
        assert busy.job is not None
        _end(busy.actor)
        self._hire()
        message = f"no answer within {self._patience_s:g} s; the worker was ended"
        return Finished(busy.job, Refusal("worker_hung", message, True))


def _end(actor: Any) -> None:
    with suppress(RayError, ValueError):
        ray.kill(actor)


def _first_line(error: BaseException) -> str:
    return (str(error).strip() or type(error).__name__).splitlines()[0]
