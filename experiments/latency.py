"""Where the milliseconds of POST /grasp go: `python -m experiments.latency --url URL`.

Asks a running backend about every bundled view, several times, and prints the
median and the 95th percentile of each stage as the gateway measured it, and of
the whole request as the client saw it.
"""

from __future__ import annotations

import argparse
import time
from collections import defaultdict
from pathlib import Path

import httpx
import numpy as np
from rich.console import Console
from rich.progress import track
from rich.table import Table

SAMPLES = Path(__file__).parent / "samples"
TASKS = {
    "bottle": "pouring",
    "hammer": "hammering",
    "ladle": "scooping",
    "saucepan": "cooking",
    "spatula": "turning",
}


def measure(url: str, repeat: int, console: Console) -> dict[str, list[float]]:
    """Return milliseconds by stage, one entry per request; the first round is not counted."""
    spent: dict[str, list[float]] = defaultdict(list)
    bodies = {name: (SAMPLES / f"{name}.npz").read_bytes() for name in TASKS}
    with httpx.Client(base_url=url, timeout=60) as client:
        for turn in track(range(repeat + 1), description="asking", console=console):
            for name, task in [*TASKS.items(), *((name, "handover") for name in TASKS)]:
                started = time.perf_counter()
                response = client.post(
                    "/grasp",
                    params={"task": task},
                    content=bodies[name],
                    headers={"Content-Type": "application/x-npz"},
                )
                seen = 1e3 * (time.perf_counter() - started)
                timings = response.raise_for_status().json()["timings_ms"]
                if turn > 0:
                    for stage, milliseconds in {**timings, "seen by the client": seen}.items():
                        spent[stage].append(milliseconds)
    return spent


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--url", default="http://127.0.0.1:8000")
    parser.add_argument("--repeat", type=int, default=10)
    arguments = parser.parse_args()
    console = Console()
    spent = measure(arguments.url, arguments.repeat, console)
    table = Table(title="POST /grasp, milliseconds")
    for column in ("stage", "median", "p95", "requests"):
        table.add_column(column)
    for stage, values in spent.items():
        median, p95 = np.percentile(values, [50, 95])
        table.add_row(stage, f"{median:.1f}", f"{p95:.1f}", str(len(values)))
    console.print(table)


if __name__ == "__main__":
    main()
