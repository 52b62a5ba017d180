"""`python -m tests.bench.rules`: how the rule set `default` does on parts of random objects."""

from __future__ import annotations

import argparse
import pickle
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

import numpy as np

from services.reasoning.reasoner import Reasoner
from services.reasoning.settings import ReasoningSettings
from shared.schemas.task import Version
from tests.bench.rules.judge import Verdict, judge, share
from tests.bench.rules.parts import CUTS, Parts, Workshop
from tests.bench.rules.views import part_views

VERSIONS: tuple[Version, ...] = ("v1", "v2")
SENSORS = {"clean": False, "noisy": True}


def made(seed: int, per_class: int, kind: str, *, noisy: bool, cache: Path | None) -> list[Parts]:
    """Return the parts of random views; from `cache` where it has them."""
    path = None if cache is None else cache / f"{kind}-{seed}-{per_class}-{noisy}.pickle"
    if path is not None and path.exists():
        held: list[Parts] = pickle.loads(path.read_bytes())
        return held
    workshop, rng = Workshop(), np.random.default_rng([seed, 1])
    found = [
        parts
        for seen in part_views(seed, per_class, kind=kind, noisy=noisy)
        for parts in workshop.parts_of(seen, rng)
    ]
    if path is not None:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(pickle.dumps(found))
    return found


def main(arguments: list[str] | None = None) -> None:
    """Make the parts, ask about them, print the counts."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench.rules", description=__doc__)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--per-class", type=int, default=10)
    parser.add_argument("--kinds", nargs="+", default=["variants", "odd"])
    parser.add_argument("--sensors", nargs="+", choices=SENSORS, default=list(SENSORS))
    parser.add_argument("--versions", nargs="+", choices=VERSIONS, default=list(VERSIONS))
    parser.add_argument("--cache", type=Path, help="keep the parts here, to ask about them again")
    parser.add_argument("--wrong", action="store_true", help="list what is wrong")
    given = parser.parse_args(arguments)
    knowledge = (
        Path(tempfile.gettempdir()) / "no-such-knowledge"
    )  # nothing learned, nothing written
    reasoner = Reasoner(ReasoningSettings(knowledge_dir=knowledge))
    reasoner.warm_up()
    say("objects           parts      version  good               refused")
    for kind in given.kinds:
        for noisy in [SENSORS[sensor] for sensor in given.sensors]:
            parts = made(given.seed, given.per_class, kind, noisy=noisy, cache=given.cache)
            for cut in CUTS:
                own = [each for each in parts if each.cut == cut]
                for version in given.versions:
                    verdicts = judge(reasoner, own, version)
                    good = [each for each in verdicts if each.afforded and each.possible]
                    unfit = [each for each in verdicts if not each.afforded]
                    name = f"{kind}{', noisy' if noisy else ''}"
                    say(f"{name:17} {cut:10} {version:8} {share(good):18} {share(unfit)}")
                    if given.wrong and version == given.versions[-1]:
                        tell(verdicts)
    reasoner.close()


def tell(verdicts: list[Verdict]) -> None:
    """Print where the rules are wrong although the parts would allow a right answer."""
    groups: dict[tuple[str, str, str], list[str]] = defaultdict(list)
    for each in verdicts:
        if not each.right and each.possible:
            what = "accepted" if not each.afforded else "wrong" if each.found else "refused"
            number = each.parts.name.rsplit("-", 1)[1]
            groups[each.parts.class_name, each.task, what].append(number)
    for (class_name, task, what), numbers in sorted(groups.items()):
        say(f"    {class_name} {task}: {what} {len(numbers)} ({' '.join(numbers)})")


def say(line: str) -> None:
    """Print a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
