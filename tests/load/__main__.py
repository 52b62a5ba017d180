"""`python -m tests.load`: throughput, latency, errors and memory of a backend under load.

Without --url it starts the embedded backend; all traffic stays on this machine.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import sys
import threading
from collections.abc import Coroutine, Iterator
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from tests.load.backend import Memory, compose_mb, embedded, unknown_mb, wait_until_ready
from tests.load.traffic import ANSWERED, Record, closed_loop, open_loop

CLIENTS = (1, 2, 4, 8, 16, 32, 64)
RATES = (0.5, 1.0, 2.0)
"""Open loop: times the throughput of the best closed loop."""
HEADER = (
    f"{'load':>22s} {'answers/s':>9s} {'p50 ms':>7s} {'p95 ms':>7s} {'p99 ms':>7s} "
    f"{'MB':>6s}  others"
)
FLAT = 0.03
"""Growth of the memory over the second half of a soak, as a share, that counts as flat."""


@dataclass
class Watch:
    """Looks at the memory while requests are sent."""

    memory: Memory
    every_s: float = 1.0
    seen_mb: list[float] = field(default_factory=list)

    @contextlib.contextmanager
    def looking(self) -> Iterator[None]:
        """Look every so often until the block ends."""
        done = threading.Event()

        def look() -> None:
            while not done.wait(self.every_s):
                self.seen_mb.append(self.memory())

        thread = threading.Thread(target=look)
        thread.start()
        try:
            yield
        finally:
            done.set()
            thread.join()

    @property
    def most_mb(self) -> float:
        return max(self.seen_mb, default=float("nan"))


def main(arguments: list[str] | None = None) -> int:
    """Print the tables; 1 if something happened that load does not explain."""
    parser = argparse.ArgumentParser(prog="python -m tests.load", description=__doc__)
    parser.add_argument("--url", help="a backend that runs already, on this machine")
    parser.add_argument("--compose", metavar="PROJECT", help="whose memory to look at, with --url")
    parser.add_argument("--seconds", type=float, default=20.0, help="of each load")
    parser.add_argument("--clients", type=int, nargs="*", default=CLIENTS)
    parser.add_argument("--rates", type=float, nargs="*", default=RATES)
    parser.add_argument("--soak", type=float, default=0.0, metavar="SECONDS")
    given = parser.parse_args(arguments)
    if given.url:
        wait_until_ready(given.url)
        held = partial(compose_mb, given.compose) if given.compose else unknown_mb
        return measure(given, given.url, held)
    with embedded() as (url, held):
        return measure(given, url, held)


def measure(given: argparse.Namespace, url: str, memory: Memory) -> int:
    """Put all loads on the backend, one after the other."""
    unexplained, best = 0, 0.0
    asyncio.run(closed_loop(url, 2, 5.0))  # everything has been used once
    say(HEADER)
    for clients in given.clients:
        record = loaded(f"{clients} clients", closed_loop(url, clients, given.seconds), memory)
        unexplained += record.unexplained()
        best = max(best, record.throughput)
    for factor in given.rates:
        rate = factor * best
        name = f"{rate:.1f}/s, {factor:g} x best"
        unexplained += loaded(name, open_loop(url, rate, given.seconds), memory).unexplained()
    if given.soak:
        unexplained += soaked(url, given.soak, memory)
    say(f"unexplained: {unexplained}")
    return int(unexplained > 0)


def loaded(name: str, requests: Coroutine[Any, Any, Record], memory: Memory) -> Record:
    """Send the requests, print a line and return what came of them."""
    watch = Watch(memory)
    with watch.looking():
        record = asyncio.run(requests)
    p50, p95, p99 = record.percentiles_ms(50, 95, 99)
    others = ", ".join(
        f"{count} {kind} (p99 {1e3 * np.percentile(record.latencies_s[kind], 99):.0f} ms)"
        for kind, count in sorted(record.counts().items())
        if kind not in ANSWERED
    )
    say(
        f"{name:>22s} {record.throughput:9.1f} {p50:7.0f} {p95:7.0f} {p99:7.0f} "
        f"{watch.most_mb:6.0f}  {others or 'none'}"
    )
    return record


def soaked(url: str, seconds: float, memory: Memory) -> int:
    """Keep four clients asking and say whether the memory stays flat; 1 more if it does not."""
    watch = Watch(memory, every_s=2.0)
    with watch.looking():
        record = asyncio.run(closed_loop(url, 4, seconds))
    half = watch.seen_mb[len(watch.seen_mb) // 2 :]
    slope = float(np.polyfit(np.linspace(0, 1, len(half)), half, 1)[0]) / float(np.median(half))
    say(
        f"soak, {seconds:.0f} s: {len(record.answered)} answers, {dict(record.counts())}; memory "
        f"{np.median(watch.seen_mb[: len(half)]):.0f} MB in the first half, "
        f"{np.median(half):.0f} in the second, {100 * slope:+.1f} % over the second "
        f"({'flat' if slope <= FLAT else 'GROWING'})"
    )
    return record.unexplained() + int(slope > FLAT)


def say(line: str) -> None:
    """Print a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
