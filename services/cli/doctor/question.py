"""A small real question: a bundled view, one task, an answer with grasps."""

from __future__ import annotations

import time

from shared.client import Sparge
from shared.settings import PROJECT_ROOT

SAMPLE = PROJECT_ROOT / "experiments" / "samples" / "bottle.npz"
TASK = "pouring"


def ask(sparge: Sparge) -> str:
    """Ask for grasps on the bundled bottle; say what the answer is.

    Raises
    ------
    ValueError
        There is no grasp in it, though this view has some.
    """
    started = time.perf_counter()
    answer = sparge.grasp_file(SAMPLE.name, SAMPLE.read_bytes(), TASK, max_grasps=3).answer
    spent_s = time.perf_counter() - started
    if not answer.grasps:
        why = f"{answer.reason.code}: {answer.reason.message}" if answer.reason else "no reason"
        raise ValueError(f"no grasp for {TASK} on the bundled bottle ({why})")
    return f"{len(answer.grasps)} grasps for {TASK} on the bundled bottle in {spent_s:.2f} s"
