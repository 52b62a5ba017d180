"""A whole run: find the files, start Ray and the workers, drive them, write the tables."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from services.annotate.book import Book
from services.annotate.drive import Driver, Summary
from services.annotate.inputs import find_inputs
from services.annotate.pipeline import StartPipeline, start_embedded
from services.annotate.question import Question
from services.annotate.ray_session import ray_session
from services.gateway.settings import GatewaySettings
from shared.errors import InvalidInput
from shared.output import sole_writer

Progress = Callable[[int, int], None]
"""Called with how many questions are settled, and of how many."""


@dataclass(frozen=True)
class Options:
    """How to run.

    Attributes
    ----------
    address : str or None
        Of a Ray cluster; None: one of this machine alone.
    workers : int or None
        None: one per processor of the machine or cluster.
    part_rows : int
        Rows of a Parquet file.
    retry_rejects : bool
        Ask again about what was rejected in an earlier run.
    start : callable
        Starts a worker's pipeline.
    patience_s : float or None
        How long a worker may take for a question; None: twice the gateway's deadline and
        30 s, since the backend gives up at the deadline unless it hangs.
    """

    address: str | None = None
    workers: int | None = None
    part_rows: int = 256
    retry_rejects: bool = False
    start: StartPipeline = start_embedded
    patience_s: float | None = None


def annotate(
    folder: Path, out: Path, question: Question, options: Options, progress: Progress
) -> Summary:
    """Settle every question about the files below `folder` that is not settled in `out`.

    Raises
    ------
    InvalidInput
        No file to ask about, or a folder that cannot be used.
    Conflict
        Another process writes to `out`, or the workers do not agree.
    SpargeError
        The question cannot be asked, or no worker can be started.
    """
    paths = find_inputs(folder)
    if not paths:
        raise InvalidInput(f"{folder} holds no cloud and no depth image")
    total = len(paths) * len(question.tasks)
    progress(0, total)
    gateway = GatewaySettings()
    settings = {name: text for name, text in os.environ.items() if name.startswith("SPARGE_")}
    patience_s = options.patience_s or 2 * gateway.deadline_s + 30.0
    with sole_writer(out), ray_session(options.address, options.workers) as workers:
        from services.annotate.ray_pool import RayPool  # imports Ray, which is set up by now

        with (
            Book(out, options.part_rows) as book,  # ends before Ray does: it holds Ray's memory
            RayPool(workers, options.start, question, settings, patience_s) as pool,
        ):
            driver = Driver(
                folder,
                question,
                pool.start(),
                book,
                gateway.max_body_bytes,
                options.retry_rejects,
                lambda settled: progress(settled, total),
            )
            return driver.run(paths, pool)
