"""The time by which the request being answered must have its answer.

It travels with the request: every hop says in `DEADLINE_HEADER` how many seconds are left,
so that no two clocks need to agree. Long computations ask `check_deadline` between their
steps and stop when nobody waits for them any more.
"""

from __future__ import annotations

import contextlib
import math
import time
from collections.abc import Iterator
from contextvars import ContextVar

from shared.errors import DeadlineExceeded

DEADLINE_HEADER = "X-Request-Timeout"
"""Seconds that are left for the answer, as a decimal number."""

_deadline: ContextVar[float] = ContextVar("deadline", default=math.inf)


@contextlib.contextmanager
def within(seconds: float) -> Iterator[None]:
    """Allow what runs inside so many seconds from now, or what was left before if that is less."""
    token = _deadline.set(min(_deadline.get(), time.monotonic() + seconds))
    try:
        yield
    finally:
        _deadline.reset(token)


@contextlib.contextmanager
def from_now(seconds: float) -> Iterator[None]:
    """Allow what runs inside so many seconds, whatever was left before: a new request begins.

    A server may start a request in the context of an earlier one of the same connection: asyncio
    keeps the context in which reading from a socket was resumed.
    """
    token = _deadline.set(time.monotonic() + seconds)
    try:
        yield
    finally:
        _deadline.reset(token)


def remaining_s() -> float:
    """Return how many seconds are left; infinite without a deadline, negative after it."""
    return _deadline.get() - time.monotonic()


def check_deadline() -> None:
    """Return while there is time.

    Raises
    ------
    DeadlineExceeded
        The deadline of the request being answered has passed.
    """
    if remaining_s() <= 0:
        raise DeadlineExceeded("the time for this request was over before its answer was ready")
