"""`python -m experiments.trials OUT --url URL`: try grasps in physics, those that are missing.

The backend at URL proposes the grasps and executes them. The objects are random variants
of the catalogue's classes and bottles held by their caps, drawn from random numbers that no
experiment draws from.
"""

from __future__ import annotations

import argparse
import logging
from pathlib import Path

from experiments.trials.collecting import collect, wait_until_ready
from experiments.trials.scenes import ROUND

ROUNDS = 60
"""So many are tried in an hour and a quarter on two busy cores."""


def main(arguments: list[str] | None = None) -> None:
    """Parse the command line and collect."""
    parser = argparse.ArgumentParser(
        prog="python -m experiments.trials", description=__doc__.splitlines()[0]
    )
    parser.add_argument("out", type=Path)
    parser.add_argument("--url", default="http://127.0.0.1:8000", help="the backend")
    parser.add_argument("--wait", type=float, default=0.0, help="seconds until it is ready")
    parser.add_argument("--objects", type=int, default=ROUNDS * ROUND, help="how many")
    parser.add_argument("--first", type=int, default=0, help="round to begin with")
    parser.add_argument("--each", type=int, default=6, help="grasps per question, two questions")
    parser.add_argument("--views", type=int, default=2, help="of each object")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--workers", type=int, default=1, help="processes that ask")
    parser.add_argument(
        "--rehearse", action="store_true", help="try each grasp on what was recovered, as well"
    )
    given = parser.parse_args(arguments)
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    logging.getLogger("httpx").setLevel(logging.WARNING)
    given.out.mkdir(parents=True, exist_ok=True)
    wait_until_ready(given.url, given.wait)
    rounds = -(-given.objects // ROUND)
    collect(
        given.out,
        given.url,
        rounds=range(given.first, given.first + rounds),
        each=given.each,
        views=given.views,
        seed=given.seed,
        workers=given.workers,
        rehearse=given.rehearse,
    )


if __name__ == "__main__":
    main()
