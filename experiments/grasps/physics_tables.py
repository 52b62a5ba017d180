"""Tables of what physics made of the best grasps."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from experiments.framework import Table
from experiments.framework.cells import Cell
from experiments.grasps.judged import Judged, shares
from experiments.grasps.tables import METHODS

_SHARES = ("right part", "lift", "strict", "right part and strict")


def physics_table(judged: Sequence[Judged]) -> Table:
    """Return one line for each set of views and method."""
    rows = []
    for source, own in _by_source(judged):
        for method, name in METHODS.items():
            mine = [each for each in own if each.asked.reasoning == method]
            if mine:
                rows.append((source, name, len(mine), *shares(mine)))
    return Table(
        "grasps-physics",
        "What a hand made of the best grasp",
        ("views", "method", "trials", *_SHARES),
        tuple(rows),
        "One grasp per view and task, no second try; no grasp is a failed trial. A free-flying "
        "hand replays it in PyBullet on the object's true mesh. Lift: raised by 30 cm and held "
        "for 1 s. Strict: then shaken by 3 cm at 2 Hz to the left and right of the camera and "
        "tilted by 60 degrees away from it, still held. "
        "Right part: the object point nearest to the grasp is in the labelled region.",
    )


def physics_by_class(judged: Sequence[Judged]) -> Table:
    """Return one line for each set of views, class and task: Version 2."""
    own = [each for each in judged if each.tried and each.asked.reasoning == "v2"]
    keys = dict.fromkeys(
        (each.asked.source, each.asked.class_name, each.asked.task) for each in own
    )
    rows = []
    for key in sorted(keys):
        mine = [
            each
            for each in own
            if (each.asked.source, each.asked.class_name, each.asked.task) == key
        ]
        rows.append((key[0], key[1] or None, key[2], len(mine), *shares(mine)))
    return Table(
        "grasps-physics-by-class",
        "What a hand made of the best grasp, Version 2, by class and task",
        ("views", "class", "task", "trials", *_SHARES),
        tuple(rows),
        detail=True,
    )


def outcomes_table(judged: Sequence[Judged]) -> Table:
    """Return how often each outcome came about."""
    every = sorted({each.outcome for each in judged if each.outcome is not None})
    rows: list[tuple[Cell, ...]] = []
    for source, own in _by_source(judged):
        for method, name in METHODS.items():
            counts = Counter(each.outcome for each in own if each.asked.reasoning == method)
            if counts:
                rows.append((source, name, *(counts[outcome] for outcome in every)))
    return Table(
        "grasps-outcomes",
        "How the trials ended",
        ("views", "method", *(outcome.replace("_", " ") for outcome in every)),
        tuple(rows),
        detail=True,
    )


def _by_source(judged: Sequence[Judged]) -> list[tuple[str, list[Judged]]]:
    tried = [each for each in judged if each.tried]
    return [
        (source, [each for each in tried if each.asked.source == source])
        for source in dict.fromkeys(each.asked.source for each in tried)
    ]
