"""How long the published form of EMS takes, beside both methods, on a few of the same views."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

import numpy as np

from experiments.framework import Table, ViewSet
from experiments.framework.views import load
from experiments.primitives.model import METHODS, Cut
from experiments.primitives.published import published_kept, published_parts

VIEWS = 6
"""Of each set of views, evenly spread: half a second and more each."""


@dataclass(frozen=True)
class ReferenceTime:
    """Seconds that a view took in the published form, and its number of points."""

    source: str
    thing: str
    view: str
    points: int
    seconds: float


def reference_times(sets: Sequence[ViewSet], views: int = VIEWS) -> list[ReferenceTime]:
    """Return the times for `views` views of each set, run in this process, one at a time."""
    found = []
    for each in sets:
        count = len(each.files)
        for index in np.unique(np.linspace(0, count - 1, min(views, count)).astype(int)):
            file = each.files[index]
            points = load(file).object_points
            started = time.perf_counter()
            published_kept(published_parts(points))
            spent = time.perf_counter() - started
            found.append(
                ReferenceTime(each.name, file.object_name, str(file.number), len(points), spent)
            )
    return found


def reference_table(times: Sequence[ReferenceTime], cuts: Sequence[Cut]) -> Table:
    """Return one line for each set: medians of the three times over the same views."""
    spent = {
        (each.source, each.thing, each.view, each.method): each.seconds
        for each in cuts
        if each.seconds is not None
    }
    rows = []
    for source in dict.fromkeys(each.source for each in times):
        triples = [
            (each.points, *asked, each.seconds)
            for each in times
            if each.source == source
            and None not in (asked := [
                spent.get((source, each.thing, each.view, method)) for method in METHODS
            ])
        ]  # fmt: skip
        if not triples:
            continue
        points, parts, ems, published = (
            median(float(row[k] or 0.0) for row in triples) for k in range(4)
        )
        rows.append(
            (
                source,
                len(triples),
                int(points),
                1e3 * parts,
                1e3 * ems,
                1e3 * published,
                published / parts,
                published / ems,
            )
        )
    return Table(
        "published",
        "Against the published form of EMS",
        (
            "views",
            "timed",
            "points",
            "parts ms",
            "ems ms",
            "published ms",
            "published / parts",
            "published / ems",
        ),
        tuple(rows),
        "Medians over a few of the views. published: the same algorithm with the parameters of "
        "Table A.1 for simulation in the form in which it was published: NumPy, SciPy's trust "
        "region method with finite differences on all points, scikit-learn's DBSCAN on all "
        "outliers, and the removal of overlap with the loops that Algorithm 2 is printed with. "
        "Written here from the papers, not the authors' code; it runs in the experiment's process "
        "on the labelled points, so no transport is in its time.",
    )
