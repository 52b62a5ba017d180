"""The tables of the experiment on parts by class, object and task."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median

from experiments.framework import MeanStd, Table
from experiments.framework.cells import Cell
from experiments.framework.scoring import GOOD_IOU
from experiments.primitives.model import Cut
from experiments.primitives.tables import (
    SCORES,
    SIZE_WORDS,
    SIZES,
    WORDS,
    grouped,
    method_name,
    regions_of,
    shares,
    size_errors,
)


def class_table(cuts: Sequence[Cut]) -> Table:
    """Return one line for each class and method, one column for each set of views."""
    sources = list(dict.fromkeys(each.source for each in cuts))
    rows: list[tuple[Cell, ...]] = [
        (
            class_name,
            method_name(mine),
            *(
                shares(regions_of(each for each in mine if each.source == source))[0]
                for source in sources
            ),
        )
        for class_name, mine in grouped(cuts, lambda each: each.class_name or each.thing)
    ]
    return Table(
        "classes",
        f"Regions that a single part meets (IoU ≥ {GOOD_IOU}), by class",
        ("class", "method", *sources),
        tuple(sorted(rows, key=lambda row: str(row[0]))),
        "Objects whose class is not known stand under their name.",
    )


def by_class(cuts: Sequence[Cut], name: str, source: str) -> Table:
    """Return all figures of one set of views, one line for each class and method."""
    rows = [
        (
            class_name,
            method_name(mine),
            *shares(regions_of(mine)),
            MeanStd.of((each.parts for each in mine), 1),
            *size_errors(mine),
        )
        for class_name, mine in grouped(cuts, lambda each: each.class_name or each.thing)
    ]
    return Table(
        name,
        f"Parts by class: {source}",
        ("class", "method", *SCORES, "parts", "compared", *SIZES, "shape right"),
        tuple(rows),
        f"{WORDS} {SIZE_WORDS}",
        detail=True,
    )


def by_region(cuts: Sequence[Cut], name: str, source: str) -> Table:
    """Return one line for each object, task and method."""
    rows: list[tuple[Cell, ...]] = []
    for thing, mine in grouped(cuts, lambda each: each.thing):
        for task in dict.fromkeys(region.task for region in regions_of(mine)):
            own = [region for region in regions_of(mine) if region.task == task]
            rows.append(
                (thing, task, method_name(mine), *shares(own), median(r.single for r in own))
            )
    return Table(
        name,
        f"Parts by object and task: {source}",
        ("object", "task", "method", *SCORES, "IoU of one, median"),
        tuple(rows),
        WORDS,
        detail=True,
    )
