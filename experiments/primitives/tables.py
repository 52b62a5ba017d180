"""The tables of the experiment on parts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from statistics import median

import numpy as np

from experiments.framework import MeanStd, Share, Table
from experiments.framework.cells import Cell
from experiments.framework.scoring import GOOD_IOU
from experiments.primitives.model import METHODS, VERY_GOOD_IOU, Cut, RegionCut

SCORES = (
    f"one ≥ {GOOD_IOU}",
    f"one ≥ {VERY_GOOD_IOU}",
    f"several ≥ {GOOD_IOU}",
    f"several ≥ {VERY_GOOD_IOU}",
)
SIZES = ("shortest", "middle", "longest")
WORDS = (
    "Counted are labelled regions, one for each view and task. One: the single part that overlaps "
    "the region most (IoU over the object's labelled points, those that perception lost "
    "included); several: the best set of parts. Both are chosen with the label in hand: what "
    "could be had of the parts, whatever the rules choose."
)
SIZE_WORDS = (
    "Median of |log(found / true)| of the full extents of the best part, where it overlaps by "
    f"{GOOD_IOU} or more, against the edges of the smallest box around the region's parts, both "
    "sorted. Shape: against the ideal body that overlaps the part's convex hull best, where it is "
    "clear which. Both truths are known for the project's own objects only."
)


def headline(cuts: Sequence[Cut]) -> Table:
    """Return one line for each set of views and method."""
    rows = [
        (
            source,
            method_name(mine),
            *shares(regions_of(mine)),
            MeanStd.of((each.parts for each in mine), 1),
            100 * float(np.mean([each.assigned for each in mine])),
            _percentile(mine, 50),
            _percentile(mine, 95),
        )
        for source, mine in grouped(cuts, lambda each: each.source)
    ]
    return Table(
        "primitives",
        "Parts against labelled regions",
        ("views", "method", *SCORES, "parts", "% assigned", "ms", "ms, p95"),
        tuple(rows),
        f"{WORDS} Assigned: share of the object's labelled points that are some part's, mean over "
        "the views; the others were lost by perception or left over. ms: median and 95th "
        "percentile of the recovery stage as the gateway measures it, one request at a time, the "
        "methods in turns; perception is not in it. ems is asked with the published parameters of "
        "Table A.1, simulation.",
    )


def size_table(cuts: Sequence[Cut]) -> Table:
    """Return one line for each set of views and method, where the true sizes are known."""
    rows = [
        (source, method_name(mine), *sizes)
        for source, mine in grouped(cuts, lambda each: each.source)
        if (sizes := size_errors(mine))[0]
    ]
    return Table(
        "sizes",
        "Size and shape of the best parts",
        ("views", "method", "compared", *SIZES, "shape right"),
        tuple(rows),
        SIZE_WORDS,
    )


def time_table(cuts: Sequence[Cut]) -> Table:
    """Return the time of both methods side by side, for views that both answered."""
    rows: list[tuple[Cell, ...]] = []
    for source in dict.fromkeys(each.source for each in cuts):
        spent = {
            method: {
                (each.thing, each.view): (1e3 * each.seconds, each.points)
                for each in cuts
                if (each.source, each.method) == (source, method) and each.seconds is not None
            }
            for method in METHODS
        }
        both = sorted(set.intersection(*(set(each) for each in spent.values())))
        if not both:
            continue
        parts, ems = (np.array([spent[method][key][0] for key in both]) for method in METHODS)
        points = [spent["parts"][key][1] for key in both]
        rows.append(
            (
                source,
                len(both),
                int(median(points)),
                float(np.median(parts)),
                float(np.percentile(parts, 95)),
                float(np.median(ems)),
                float(np.percentile(ems, 95)),
                float(np.median(ems) / np.median(parts)),
                float(np.median(ems / parts)),
            )
        )
    return Table(
        "time",
        "Recovery in milliseconds, both methods in one run",
        (
            "views",
            "timed",
            "points",
            "parts ms",
            "parts p95",
            "ems ms",
            "ems p95",
            "ratio",
            "paired ratio",
        ),
        tuple(rows),
        "The stage with its way there and back, as the gateway measures it; one request at a time. "
        "ms and points: medians. Ratio: median of ems, with the published parameters, over that "
        "of parts. Paired: median of the ratios view by view.",
    )


def regions_of(cuts: Iterable[Cut]) -> list[RegionCut]:
    """Return all labelled regions."""
    return [region for each in cuts for region in each.regions]


def method_name(cuts: Sequence[Cut]) -> str:
    """Return the method that was asked for, and the one that answered if it was another."""
    answered = sorted({each.answered for each in cuts if each.answered} - {cuts[0].method})
    return cuts[0].method + (f" (answered by {', '.join(answered)})" if answered else "")


def grouped(cuts: Sequence[Cut], key: Callable[[Cut], str]) -> list[tuple[str, list[Cut]]]:
    """Return the cuts by key and method, in the order in which keys come."""
    groups = []
    for value in dict.fromkeys(key(each) for each in cuts):
        for method in METHODS:
            mine = [each for each in cuts if key(each) == value and each.method == method]
            if mine:
                groups.append((value, mine))
    return groups


def shares(regions: Sequence[RegionCut]) -> tuple[Share, Share, Share, Share]:
    """Return which share one part meets, well and very well, and which several parts do."""
    one, very, several, very_several = (
        Share.of(iou >= limit for iou in values)
        for values in ([r.single for r in regions], [r.union for r in regions])
        for limit in (GOOD_IOU, VERY_GOOD_IOU)
    )
    return one, very, several, very_several


def size_errors(cuts: Sequence[Cut]) -> tuple[Cell, ...]:
    """Return how many parts are compared, the three errors of size, the share of right names."""
    regions = regions_of(cuts)
    errors = [each.extents for each in regions if each.extents is not None]
    named = [each.shape_is_right for each in regions if each.shape_is_right is not None]
    middle = np.median(np.abs(errors), axis=0).tolist() if errors else [None] * len(SIZES)
    return len(errors), *middle, Share.of(named)


def _percentile(cuts: Sequence[Cut], percent: int) -> Cell:
    spent = [1e3 * each.seconds for each in cuts if each.seconds is not None]
    return float(np.percentile(spent, percent)) if spent else None
