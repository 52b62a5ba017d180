"""Work shared out among processes that end with the one that started them."""

from __future__ import annotations

import multiprocessing
import multiprocessing.connection
import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from typing import TypeVar

from shared.errors import InternalError

Job = TypeVar("Job")
Work = Callable[[Job], None]


def carry_out(work: Work[Job], jobs: Sequence[Job], workers: int) -> Iterator[None]:
    """Do every job, yielding after each, in no particular order.

    Parameters
    ----------
    work : callable
        Does one job. It is sent to every process once, so it may carry much.
    jobs : sequence
        Small things that can be pickled.
    workers : int
        Processes; 1 works in this one.

    Raises
    ------
    InternalError
        A process was killed.
    """
    if workers == 1 or len(jobs) < 2:
        for job in jobs:
            work(job)
            yield
        return
    pool = ProcessPoolExecutor(
        min(workers, len(jobs)),
        mp_context=multiprocessing.get_context("spawn"),  # threads do not survive a fork
        initializer=_start,
        initargs=(work,),
    )
    try:
        for future in as_completed([pool.submit(_do, job) for job in jobs]):
            future.result()
            yield
    except BrokenProcessPool:
        raise InternalError("a worker process was killed; the same command goes on") from None
    finally:
        pool.shutdown(cancel_futures=True)


_of_this_process: list[Callable[..., None]] = []


def _start(work: Callable[..., None]) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent to handle
    _of_this_process.append(work)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent.sentinel,), daemon=True).start()


def _end_with(sentinel: int) -> None:
    multiprocessing.connection.wait([sentinel])
    os._exit(1)


def _do(job: object) -> None:
    _of_this_process[0](job)
