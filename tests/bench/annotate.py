"""`python -m tests.bench.annotate`: what Ray and the tables cost, and what a second worker brings.

The same questions about the same files, in turn: by a bare loop in this process, by one worker
and by two, each from the first question to the last row on the disk. All are warm before, and
stay. Wall time, and the processor time of everything below this process.
"""

from __future__ import annotations

import argparse
import os
import shutil
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

from services.annotate.book import Book
from services.annotate.drive import Driver
from services.annotate.inputs import find_inputs
from services.annotate.pipeline import Pipeline, start_embedded
from services.annotate.question import Question
from services.annotate.ray_session import ray_session
from tests.support.samples import SAMPLES

QUESTION = Question(("handover", "pouring"), {"max_grasps": 10, "seed": 0})
SETTLE_S = 15.0
"""Until what a backend warms up after its start is done."""

Arm = Callable[[], None]


def main(arguments: list[str] | None = None) -> None:
    """Print a line per run, then the medians."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.bench.annotate", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--rounds", type=int, default=5, help="of all three, in turning order")
    parser.add_argument("--copies", type=int, default=6, help="of the five bundled views")
    given = parser.parse_args(arguments)
    with ExitStack() as stack:
        scratch = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="sparge-annotate-")))
        os.environ["SPARGE_REASONING_KNOWLEDGE_DIR"] = str(scratch / "knowledge")
        folder = copy_views(scratch / "in", given.copies)
        arms = start_arms(stack, folder, scratch)
        time.sleep(SETTLE_S)
        asked = len(find_inputs(folder)) * len(QUESTION.tasks)
        measure(arms, given.rounds, asked)


def copy_views(folder: Path, copies: int) -> Path:
    """Fill `folder` with the bundled views, each so many times."""
    folder.mkdir()
    for path in sorted(SAMPLES.glob("*.npz")):
        if not path.name.endswith(".labels.npz"):
            for number in range(copies):
                shutil.copy(path, folder / f"{number:03d}-{path.name}")
    return folder


def start_arms(stack: ExitStack, folder: Path, scratch: Path) -> dict[str, Arm]:
    """Start what is compared, one after the other; all of it ends with `stack`."""
    stack.enter_context(ray_session(None, 3))
    from services.annotate.ray_pool import RayPool

    bare = stack.enter_context(start_embedded())
    pools = {}
    for size in (1, 2):
        pool = RayPool(size, start_embedded, QUESTION, dict(os.environ), 300.0)
        pools[size] = (stack.enter_context(pool), pool.start())
        while pool.ready < size:
            pool.take()

    def on_ray(size: int) -> None:
        pool, terms = pools[size]
        with (
            tempfile.TemporaryDirectory(dir=scratch) as out,
            Book(Path(out), part_rows=256) as book,
        ):
            driver = Driver(folder, QUESTION, terms, book, 2**25)
            assert driver.run(find_inputs(folder), pool).annotated > 0

    return {
        "bare loop": lambda: ask_all(bare, folder),
        "1 worker": lambda: on_ray(1),
        "2 workers": lambda: on_ray(2),
    }


def ask_all(pipeline: Pipeline, folder: Path) -> None:
    """Ask every question, one after the other, and keep nothing."""
    for path in find_inputs(folder):
        data = path.read_bytes()
        for task in QUESTION.tasks:
            pipeline.grasp_file(path.name, data, task, **QUESTION.parameters)


def measure(arms: dict[str, Arm], rounds: int, asked: int) -> None:
    """Run all arms in every round, each time another one first, and print the times."""
    names = list(arms)
    taken: dict[str, list[tuple[float, float]]] = {name: [] for name in names}
    for name in names:  # a first time that does not count
        arms[name]()
    for number in range(rounds):
        for at in range(len(names)):
            name = names[(number + at) % len(names)]
            wall, processor = time.perf_counter(), processor_s()
            arms[name]()
            wall, processor = time.perf_counter() - wall, processor_s() - processor
            taken[name].append((1e3 * wall / asked, 1e3 * processor / asked))
            say(
                f"round {number + 1}  {name:9}  {taken[name][-1][0]:6.1f} ms a question"
                f"  {taken[name][-1][1]:6.1f} ms of processors  load {os.getloadavg()[0]:.1f}"
            )
    say(f"\nmedians of {rounds} rounds, {asked} questions each: wall, processors (ms a question)")
    for name in names:
        walls, processors = zip(*taken[name], strict=True)
        say(f"{name:9}  {statistics.median(walls):6.1f}  {statistics.median(processors):6.1f}")
    for which, kind in enumerate(("wall", "processors")):
        overhead = ratio(taken["1 worker"], taken["bare loop"], which) - 1
        say(f"one worker over a bare loop, {kind}: {100 * overhead:+.1f} %")
    gain = ratio(taken["1 worker"], taken["2 workers"], 0)
    say(f"two workers are {gain:.2f} times as fast as one")


def ratio(over: list[tuple[float, float]], under: list[tuple[float, float]], which: int) -> float:
    """Return the median of the ratios within each round."""
    return statistics.median(a[which] / b[which] for a, b in zip(over, under, strict=True))


def processor_s() -> float:
    """Return the processor time of this process and all that live below it, in seconds."""
    parents, ticks = {}, {}
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = path.read_text().rpartition(")")[2].split()
        except OSError:  # ended meanwhile
            continue
        parents[int(path.parent.name)] = int(fields[1])
        ticks[int(path.parent.name)] = int(fields[11]) + int(fields[12])
    total = 0
    for process in ticks:
        above: int | None = process
        while above and above != os.getpid():
            above = parents.get(above)
        total += ticks[process] if above else 0
    return total / os.sysconf("SC_CLK_TCK")


def say(line: str) -> None:
    """Print a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
