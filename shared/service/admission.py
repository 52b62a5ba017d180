"""Who may work now, who waits, and who is sent away: the bounded queue of one service.

A service computes; more requests at once than processors make every one of them slower and
hold memory. So a few run, some wait in the order of their coming, and who would wait longer
than it is worth is told so at once, with the time after which to ask again. The bound is one of
time, not only of number: how long a queue takes depends on the machine and on the requests,
so the wait is estimated from how long the last requests ran.
"""

from __future__ import annotations

import asyncio
import contextlib
import math
import threading
import time
from collections import deque
from collections.abc import AsyncIterator, Callable
from typing import TypeVar

import anyio.to_thread

from shared.deadline import check_deadline, remaining_s
from shared.errors import DeadlineExceeded, TooBusy
from shared.settings import ServiceSettings

T = TypeVar("T")

_MEMORY = 16
"""Requests over which the running time is averaged, exponentially."""


class Admission:
    """The bounded queue of a service; used from one event loop.

    Parameters
    ----------
    service : str
        For messages.
    settings : ServiceSettings
        `concurrency` requests run at once, `max_waiting` wait, none that is expected to wait
        longer than `queue_wait_s`.
    """

    def __init__(self, service: str, settings: ServiceSettings) -> None:
        self._service = service
        self._settings = settings
        self._waiting: deque[asyncio.Future[None]] = deque()
        self._mean_s = 0.0
        self._threads: anyio.CapacityLimiter | None = None
        self.running = 0
        self.on_refusal: Callable[[], object] = lambda: None

    @property
    def waiting(self) -> int:
        """How many wait for their turn."""
        return len(self._waiting)

    def expected_wait_s(self) -> float:
        """Estimate how long a request that came now would wait."""
        if self.running < self._settings.concurrency:
            return 0.0
        return (self.waiting + 1) * self._mean_s / self._settings.concurrency

    @contextlib.asynccontextmanager
    async def turn(self) -> AsyncIterator[None]:
        """Run the body when it is its turn.

        Raises
        ------
        TooBusy
            At once, when the queue is full or too slow.
        DeadlineExceeded
            The request's time was over before its turn came.
        """
        await self._enter()
        started = time.perf_counter()
        try:
            yield
        finally:
            self._leave(time.perf_counter() - started)

    async def in_thread(self, work: Callable[[], T]) -> T:
        """Return what `work` returns, computed in a thread when it is its turn.

        Who is cancelled leaves at once. A thread cannot be stopped from outside, so it keeps
        its place until it ends, which work that asks `check_deadline` does soon.

        Raises
        ------
        TooBusy, DeadlineExceeded
            As in `turn`; also whatever `work` raises.
        """
        await self._enter()
        loop = asyncio.get_running_loop()
        unclaimed = threading.Lock()  # taken by the thread that begins, or by who leaves before

        def compute() -> T:
            if not unclaimed.acquire(blocking=False):
                raise asyncio.CancelledError
            started = time.perf_counter()
            try:
                check_deadline()
                return work()
            finally:
                with contextlib.suppress(RuntimeError):  # the loop has ended meanwhile
                    loop.call_soon_threadsafe(self._leave, time.perf_counter() - started)

        if self._threads is None:
            self._threads = anyio.CapacityLimiter(math.inf)  # the queue is the limit
        try:
            return await anyio.to_thread.run_sync(
                compute, abandon_on_cancel=True, limiter=self._threads
            )
        except asyncio.CancelledError:
            if unclaimed.acquire(blocking=False):
                self._leave(None)
            raise

    async def _enter(self) -> None:
        check_deadline()
        if self.running < self._settings.concurrency:
            self.running += 1
            return
        wait_s = self.expected_wait_s()
        if self.waiting >= self._settings.max_waiting or wait_s > self._settings.queue_wait_s:
            self.on_refusal()
            raise TooBusy(
                f"{self._service} is busy: {self.running} requests are worked on and "
                f"{self.waiting} wait, about {wait_s:.1f} s",
                stage=self._service,
                retry_after_s=max(1, math.ceil(wait_s)),
            )
        turn = asyncio.get_running_loop().create_future()
        self._waiting.append(turn)
        left = remaining_s()
        try:
            async with asyncio.timeout(left if math.isfinite(left) else None):
                await turn
        except BaseException as error:
            if turn.done() and not turn.cancelled():
                self._leave(None)  # the turn came in the same moment
            elif turn in self._waiting:
                self._waiting.remove(turn)
            if isinstance(error, TimeoutError):
                raise DeadlineExceeded(
                    f"the time for this request was over while it waited for {self._service}",
                    stage=self._service,
                ) from None
            raise

    def _leave(self, spent_s: float | None) -> None:
        """Hand the place to the next in the queue; `spent_s` None: nothing was done in it."""
        if spent_s is not None:
            weight = 1 / _MEMORY if self._mean_s else 1.0
            self._mean_s += weight * (spent_s - self._mean_s)
        while self._waiting:
            turn = self._waiting.popleft()
            if not turn.done():
                turn.set_result(None)
                return
        self.running -= 1
