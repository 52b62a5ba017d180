"""What is asked again by itself, when, and for how long.

Asked again, with growing and random pauses and all within one deadline:

- Anything that was never sent: the connection was refused or could not be made.
- Anything that was sent away with 429 and a `Retry-After`: the backend refuses before it works.
- What changes nothing (a grasp, an execution in simulation, every list) after a 503 with a
  `Retry-After`, and after a connection that broke before the answer was whole.

Never asked again: a change of the knowledge that may have been made (its connection broke, its
stage went away), other errors 4xx, which come out the same, and what ran out of time: there is
none left, and to whoever is late because of load twice the load is no help.
"""

from __future__ import annotations

import email.utils
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import httpx
import numpy as np

from shared.client.question import BACKEND, Question
from shared.deadline import DEADLINE_HEADER, remaining_s
from shared.errors import DeadlineExceeded, InvalidInput, SpargeError
from shared.service.client import unavailable
from shared.service.request_id import REQUEST_ID_HEADER

T = TypeVar("T")

NEVER_SENT = (httpx.ConnectError, httpx.ConnectTimeout, httpx.PoolTimeout)
BROKEN = (httpx.NetworkError, httpx.RemoteProtocolError)
TIMEOUT_S = 120.0
"""For an answer; the backend's own deadlines (30 s, and 60 s for an execution) come first."""
CONNECT_S = 10.0
"""A connection that takes longer will not come."""
ANSWER_MARGIN_S = 0.25
"""By how much earlier than its client the backend gives up, so that its error still arrives."""


@dataclass(frozen=True)
class RetryPolicy:
    """How patient a client is.

    Attributes
    ----------
    attempts : int
        How often a question is asked at most; 1: never again.
    backoff_s, max_backoff_s : float
        The pause before the n-th repetition is drawn evenly from zero to `backoff_s * 2**(n-1)`,
        or `max_backoff_s` if that is less ("full jitter"), after what `Retry-After` says.
    """

    attempts: int = 4
    backoff_s: float = 0.5
    max_backoff_s: float = 8.0

    def __post_init__(self) -> None:
        if self.attempts < 1 or not 0 <= self.backoff_s <= self.max_backoff_s:
            raise InvalidInput(f"a question is asked at least once, pauses are positive: {self}")

    def backoff(self, asked: int, rng: np.random.Generator) -> float:
        """Return seconds to wait after having asked so often."""
        bound = min(self.backoff_s * 2.0 ** min(asked - 1, 60), self.max_backoff_s)
        return float(rng.uniform(0.0, bound))


UNTIL_READY = RetryPolicy(attempts=1_000_000, backoff_s=0.1, max_backoff_s=0.5)
"""For a backend that is starting."""


class Attempts(Generic[T]):
    """One question on its way: says what to send, and after each outcome what to do.

    Parameters
    ----------
    question : Question
    policy : RetryPolicy
    timeout_s : float
        For all attempts and the pauses between them; the deadline of a request that this
        process is answering counts, too.
    rng : numpy.random.Generator, optional
        Draws the pauses.
    clock : callable, optional
        Seconds since some fixed time.
    """

    def __init__(
        self,
        question: Question[T],
        policy: RetryPolicy,
        timeout_s: float,
        rng: np.random.Generator | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._question = question
        self._policy = policy
        self._rng = rng
        self._clock = clock
        self._timeout_s = min(timeout_s, remaining_s())
        self._until = clock() + self._timeout_s
        self._asked = 0

    def left_s(self) -> float:
        """Return how much time there is."""
        return self._until - self._clock()

    def request(self) -> tuple[str, str, dict[str, Any]]:
        """Return method, URL and options, as of an httpx client's `request`, of the next attempt.

        Raises
        ------
        DeadlineExceeded
            There is no time for it.
        """
        left_s = self.left_s()
        if left_s <= 0:
            raise self._named(self._late())
        self._asked += 1
        told_s = max(left_s - ANSWER_MARGIN_S, 0.9 * left_s)
        question = self._question
        options = {
            "headers": {**question.headers, DEADLINE_HEADER: f"{told_s:.3f}"},
            "timeout": httpx.Timeout(left_s, connect=min(left_s, CONNECT_S)),
            **question.body,
        }
        return question.method, question.url, options

    def pause_after(self, outcome: httpx.Response | Exception) -> float | None:
        """Return the seconds to wait before the next attempt; None: the outcome is the answer.

        Raises
        ------
        StageUnavailable, DeadlineExceeded
            There was no answer, and it is not asked again.
        """
        if self._asked < self._policy.attempts and self._may_repeat(outcome):
            pause_s = _invited_s(outcome) + self._policy.backoff(self._asked, self._random())
            if pause_s < self.left_s():
                return pause_s
        if isinstance(outcome, httpx.Response):
            return None
        raise self._named(self._failure(outcome)) from None

    def read(self, answer: httpx.Response) -> T:
        """Return what an answer means, or raise the error that it is, with the request's id."""
        try:
            return self._question.read(answer)
        except SpargeError as error:
            raise self._named(error) from None

    def _may_repeat(self, outcome: httpx.Response | Exception) -> bool:
        if isinstance(outcome, httpx.Response):
            refused = outcome.status_code == 429
            return self._question.again(outcome) and (refused or not self._question.changes)
        if isinstance(outcome, NEVER_SENT):
            return True
        return isinstance(outcome, BROKEN) and not self._question.changes

    def _random(self) -> np.random.Generator:
        self._rng = self._rng or np.random.default_rng()
        return self._rng

    def _failure(self, outcome: Exception) -> SpargeError:
        late = isinstance(outcome, TimeoutError | httpx.TimeoutException)
        if late and not isinstance(outcome, NEVER_SENT):
            return self._late()
        why = str(outcome) or type(outcome).__name__
        often = f" (asked {self._asked} times)" if self._asked > 1 else ""
        return unavailable(BACKEND, f"cannot be reached: {why}{often}")

    def _late(self) -> DeadlineExceeded:
        return DeadlineExceeded(
            f"the backend did not answer within {self._timeout_s:g} s",
            stage=BACKEND,
            timeout_s=self._timeout_s,
        )

    def _named(self, error: SpargeError) -> SpargeError:
        error.request_id = error.request_id or self._question.headers[REQUEST_ID_HEADER]
        return error


def _invited_s(outcome: httpx.Response | Exception) -> float:
    """Return the seconds that `Retry-After` names, as a number or as a date; else 0."""
    text = outcome.headers.get("retry-after", "") if isinstance(outcome, httpx.Response) else ""
    if text.strip().isdigit():
        return float(text)
    try:
        return max(email.utils.parsedate_to_datetime(text).timestamp() - time.time(), 0.0)
    except (TypeError, ValueError):
        return 0.0
