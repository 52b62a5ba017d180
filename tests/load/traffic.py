"""Clients that ask a backend: so many at a time, or so many a second."""

from __future__ import annotations

import asyncio
import itertools
import time
from collections import Counter
from collections.abc import Callable, Coroutine, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import httpx
import numpy as np
import orjson

from tests.support.samples import sample_path

TASKS = ("pouring", "handover", "hammering", "cooking", "scooping")
SAMPLES = ("bottle", "hammer", "ladle", "saucepan", "spatula")
TIMEOUT_S = 60.0
FOUND, NOT_FOUND = "found", "not found"
ANSWERED = (FOUND, NOT_FOUND)
EXPLAINED = (*ANSWERED, "too_busy", "rate_limited", "deadline_exceeded")
"""What a healthy backend may say under load."""


class Question(NamedTuple):
    """A request, ready to be sent."""

    body: bytes
    task: str
    seed: int


def questions() -> Iterator[Question]:
    """Return every sample with every task, over and over, each time with another seed."""
    bodies = [sample_path(name).read_bytes() for name in SAMPLES]
    for seed in itertools.count():
        for body, task in itertools.product(bodies, TASKS):
            yield Question(body, task, seed)


@dataclass
class Record:
    """What came of the requests of a while.

    Attributes
    ----------
    seconds : float
        How long requests were sent.
    latencies_s : dict
        By kind of answer: an error's code, `found`, `not found`, or what broke.
    """

    seconds: float
    latencies_s: dict[str, list[float]] = field(default_factory=dict)

    def add(self, kind: str, latency_s: float) -> None:
        """Count one answer."""
        self.latencies_s.setdefault(kind, []).append(latency_s)

    @property
    def answered(self) -> list[float]:
        """Latencies of the answers, found or not, in seconds."""
        return [each for kind in ANSWERED for each in self.latencies_s.get(kind, ())]

    @property
    def throughput(self) -> float:
        """Answers a second."""
        return len(self.answered) / self.seconds

    def counts(self) -> Counter[str]:
        """Return how many there are of each kind."""
        return Counter({kind: len(each) for kind, each in self.latencies_s.items()})

    def unexplained(self) -> int:
        """Return how many requests came to something that load does not explain."""
        return sum(count for kind, count in self.counts().items() if kind not in EXPLAINED)

    def percentiles_ms(self, *wanted: float) -> list[float]:
        """Return percentiles of the answers' latencies; NaN where there is none."""
        answered = self.answered
        if not answered:
            return [float("nan")] * len(wanted)
        found: list[float] = (1e3 * np.percentile(answered, wanted)).tolist()
        return found


async def closed_loop(url: str, clients: int, seconds: float) -> Record:
    """Let `clients` ask, each again as soon as it has its answer; who is refused waits a little."""
    asked, record = questions(), Record(seconds)

    async def client(http: httpx.AsyncClient) -> None:
        until = time.perf_counter() + seconds
        while time.perf_counter() < until:
            if await ask(http, next(asked), record) not in ANSWERED:
                await asyncio.sleep(0.1)

    await _run(url, [client] * clients)
    return record


async def open_loop(url: str, rate_per_s: float, seconds: float, seed: int = 0) -> Record:
    """Send requests at random times, `rate_per_s` on average, whatever became of those before."""
    rng = np.random.default_rng(seed)
    asked, record = questions(), Record(seconds)
    times = np.cumsum(rng.exponential(1 / rate_per_s, size=int(2 * rate_per_s * seconds) + 10))

    async def arrivals(http: httpx.AsyncClient) -> None:
        started = time.perf_counter()
        async with asyncio.TaskGroup() as group:
            for due in times[times < seconds]:
                await asyncio.sleep(max(0.0, started + float(due) - time.perf_counter()))
                group.create_task(ask(http, next(asked), record))

    await _run(url, [arrivals])
    return record


async def ask(http: httpx.AsyncClient, question: Question, record: Record) -> str:
    """Send one request, record what came of it, and return its kind."""
    started = time.perf_counter()
    try:
        response = await http.post(
            "/grasp",
            params={"task": question.task, "seed": question.seed},
            content=question.body,
            headers={"Content-Type": "application/x-npz"},
        )
        kind = _kind(response)
    except httpx.HTTPError as error:
        kind = type(error).__name__
    record.add(kind, time.perf_counter() - started)
    return kind


def _kind(response: httpx.Response) -> str:
    try:
        body: dict[str, Any] = orjson.loads(response.content)
        if response.status_code == 200:
            return FOUND if body["found"] else NOT_FOUND
        return str(body["error"]["code"])
    except (orjson.JSONDecodeError, KeyError, TypeError):
        return f"status {response.status_code} without an envelope"


async def _run(
    url: str, clients: Sequence[Callable[[httpx.AsyncClient], Coroutine[Any, Any, None]]]
) -> None:
    limits = httpx.Limits(max_connections=None)
    async with (
        httpx.AsyncClient(base_url=url, timeout=TIMEOUT_S, limits=limits) as http,
        asyncio.TaskGroup() as group,
    ):
        for client in clients:
            group.create_task(client(http))
