"""`python -m tests.bench`: speed and memory of reasoning; `make bench`."""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from services.reasoning.reasoner import Reasoner
from services.reasoning.settings import ReasoningSettings
from tests.bench import soak, speed


def main(arguments: list[str] | None = None) -> int:
    """Print the tables; 1 if the memory is not flat."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench", description=__doc__)
    parser.add_argument("--requests", type=int, default=100_000, help="of the soak")
    parser.add_argument("--rounds", type=int, default=5, help="how often each question is timed")
    given = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as folder:
        windows: list[soak.Window] = []
        reasoner = Reasoner(ReasoningSettings(knowledge_dir=Path(folder) / "soaked"))
        reasoner.warm_up()
        say(soak.HEADER)
        for window in soak.soak(reasoner, given.requests):
            windows.append(window)
            say(window.line())
        reasoner.close()
        grown = soak.growth(windows)
        flat = abs(grown) <= soak.FLAT or grown < 0
        say(
            f"memory over the second half: {100 * grown:+.2f} % ({'flat' if flat else 'GROWING'})\n"
        )
        reasoner = Reasoner(ReasoningSettings(knowledge_dir=Path(folder) / "timed"))
        reasoner.warm_up()
        say(speed.HEADER)
        for taken in speed.speeds(reasoner, given.rounds):
            say(taken.line())
        reasoner.close()
    return 0 if flat else 1


def say(line: str) -> None:
    """Print a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
