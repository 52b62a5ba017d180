"""`python -m tests.bench.scaling`: cost per request of every service, and sizing from it.

Every service runs alone, as in its image. Processor time is the kernel's count for the
processes, so that other work on the machine changes it far less than it changes the clock.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from statistics import median

import httpx

from shared.schemas.answer import GraspAnswer
from tests.bench.scaling.measure import (
    SERVICES,
    Backend,
    Cost,
    deployed,
    execute,
    execution_of,
    grasp,
)
from tests.bench.scaling.questions import Question, catalogue_questions, sample_questions
from tests.bench.scaling.sizing import size

SINGLE_THREADED = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
"""As in docker/kubernetes: requests run beside each other, not each on all cores."""
ASKED = tuple(name for name in SERVICES if name != "execution")
"""The services that POST /grasp asks."""
TIMEOUT_S = 120.0


def main(arguments: list[str] | None = None) -> None:
    """Measure and print the tables."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench.scaling")
    parser.add_argument("--views", type=int, default=1, help="of each catalogue object; 0: none")
    parser.add_argument("--seed", type=int, default=0, help="of the catalogue's views")
    parser.add_argument("--rounds", type=int, default=4, help="how often everything is asked")
    parser.add_argument("--clients", type=int, default=1, help="that ask at a time")
    parser.add_argument("--executions", type=int, default=20, help="of POST /execute")
    parser.add_argument("--idle", type=int, default=10, help="seconds without requests")
    parser.add_argument("--rate", type=float, default=1000.0, help="requests a second to size for")
    parser.add_argument("--share", type=float, default=0.6, help="of a pod's core that is used")
    parser.add_argument("--folder", type=Path, default=Path("results"), help="keeps the views")
    given = parser.parse_args(arguments)
    questions = list(sample_questions())
    if given.views:
        questions += catalogue_questions(given.folder / "scaling", given.views, given.seed)
    with (
        tempfile.TemporaryDirectory() as folder,
        deployed(Path(folder), SINGLE_THREADED) as backend,
        httpx.Client(base_url=backend.url, timeout=TIMEOUT_S) as http,
    ):
        answers = ask_all(http, questions, given.clients)  # warms up, and is not counted
        rounds = [
            backend.costs(lambda: len(ask_all(http, questions, given.clients)))
            for _ in range(given.rounds)
        ]
        peaks = backend.peak_mb()
        idle = backend.costs(lambda: rest(given.idle))
        say(
            f"POST /grasp, {given.rounds} rounds of {len(questions)} requests by {given.clients} "
            f"at a time, {sum(bool(each.grasps) for each in answers)} answered with grasps; "
            f"load average {os.getloadavg()[0]:.1f}"
        )
        say_costs(rounds, idle, peaks)
        say_sizes(rounds, peaks, given.rate, given.share)
        say_executions(backend, http, answers, given.executions)


def ask_all(http: httpx.Client, questions: Sequence[Question], clients: int) -> list[GraspAnswer]:
    """Ask everything once, `clients` at a time."""
    with ThreadPoolExecutor(clients) as pool:
        return list(pool.map(lambda question: grasp(http, question), questions))


def rest(seconds: int) -> int:
    """Do nothing for so many seconds; return how many."""
    time.sleep(seconds)
    return seconds


def say_costs(
    rounds: Sequence[Mapping[str, Cost]], idle: Mapping[str, Cost], peaks: Mapping[str, float]
) -> None:
    """Print what a request costs each service: the median round, the least and the most."""
    total = sum(cpu_ms(rounds, name) for name in SERVICES)
    say(
        f"\n{'service':<20} {'CPU ms':>7} {'least':>7} {'most':>7} {'share %':>8} "
        f"{'in kB':>8} {'out kB':>8} {'connections':>12} {'peak MB':>8} {'idle ms/s':>10}"
    )
    for name in SERVICES:
        every = [costs[name].cpu_ms for costs in rounds]
        last = rounds[-1][name]
        say(
            f"{name:<20} {median(every):7.1f} {min(every):7.1f} {max(every):7.1f} "
            f"{100 * median(every) / total:8.1f} {last.received_kb:8.1f} {last.answered_kb:8.1f} "
            f"{last.connections:12.2f} {peaks[name]:8.0f} {idle[name].cpu_ms:10.1f}"
        )
    say(f"{'all':<20} {total:7.1f}")


def say_sizes(
    rounds: Sequence[Mapping[str, Cost]], peaks: Mapping[str, float], rate: float, share: float
) -> None:
    """Print what `rate` requests a second need."""
    say(f"\nsizing to {rate:g} requests a second, pods of one core busy for {100 * share:g} %")
    say(f"{'service':<20} {'busy cores':>10} {'pods':>6} {'memory GB':>10} {'Mbit/s':>8}")
    pods = 0
    for name in ASKED:
        last = rounds[-1][name]
        kilobytes = last.received_kb + last.answered_kb
        needed = size(rate, cpu_ms(rounds, name), kilobytes, peaks[name], share)
        pods += needed.pods
        say(
            f"{name:<20} {needed.cores:10.1f} {needed.pods:6d} {needed.memory_gb:10.1f} "
            f"{needed.megabits:8.0f}"
        )
    say(f"{'all':<20} {rate * sum(cpu_ms(rounds, n) for n in ASKED) / 1e3:10.1f} {pods:6d}")


def say_executions(
    backend: Backend, http: httpx.Client, answers: Sequence[GraspAnswer], count: int
) -> None:
    """Print what POST /execute costs, for the best grasps of the first answers that have one."""
    bodies = [execution_of(each) for each in answers if each.grasps][:count]
    if not bodies:
        return
    execute(http, bodies[:1])
    costs = backend.costs(lambda: execute(http, bodies))
    peaks = backend.peak_mb()
    say(f"\nPOST /execute, {len(bodies)} requests")
    for name in ("gateway", "execution"):
        say(f"{name:<20} {costs[name].cpu_ms:7.1f} CPU ms {peaks[name]:8.0f} MB at the peak")


def cpu_ms(rounds: Sequence[Mapping[str, Cost]], name: str) -> float:
    """Return the median round's processor time of a request."""
    return median(costs[name].cpu_ms for costs in rounds)


def say(line: str) -> None:
    """Print a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
