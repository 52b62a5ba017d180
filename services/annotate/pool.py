"""What hands questions to workers, whatever the workers are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

from services.annotate.question import Job


class Finished(NamedTuple):
    """What became of a job: a row (`pyarrow.RecordBatch`) or a `Refusal`."""

    job: Job
    outcome: Any


class WorkerPool(Protocol):
    """Workers, each with at most one job."""

    @property
    def idle(self) -> int:
        """How many workers wait for a job."""

    def give(self, job: Job) -> None:
        """Give a job to an idle worker."""

    def take(self) -> Sequence[Finished]:
        """Wait a while for jobs to be finished, or for workers to become idle.

        Every job that was given comes back exactly once, also when its worker dies.

        Raises
        ------
        StageUnavailable
            No worker can be started.
        """
