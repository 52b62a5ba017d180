"""The tables of experiment 2."""

from __future__ import annotations

from collections.abc import Sequence

from experiments.framework import Asked, MeanStd, Share, Table
from experiments.framework.asking import VERSIONS
from experiments.framework.cells import Cell
from experiments.framework.scoring import GOOD_IOU
from experiments.framework.thesis import TABLE_6_3, TABLE_6_3_AVERAGE, TABLE_6_4, TABLE_6_4_AVERAGE

_WORDS = (
    "Precision is TP/(TP+FP), the quantity that the thesis's code computes as its TPR; both stand "
    "side by side. Means are over the views where a region was found, ± is the standard "
    "deviation (n - 1). Good: IoU >= 0.7, over all views, found or not, with the 95 % Wilson "
    "interval. Ours counts every labelled point of the object, the thesis's those of its "
    "segmented cloud."
)


def headline(asked: Sequence[Asked]) -> Table:
    """Return one line for each set of views and version."""
    rows: list[tuple[Cell, ...]] = []
    for source in dict.fromkeys(each.source for each in asked):
        for version in VERSIONS:
            mine = [each for each in asked if (each.source, each.reasoning) == (source, version)]
            own = [each for each in mine if each.afforded]
            rows.append(
                (
                    source,
                    version,
                    *_scores(own),
                    Share.of(each.grasp_in_region for each in own),
                    Share.of(each.refused for each in mine if not each.afforded),
                )
            )
    for title, average in (
        ("thesis, Table 6.3", TABLE_6_3_AVERAGE),
        ("thesis, Table 6.4 (YCB)", TABLE_6_4_AVERAGE),
    ):
        for version in VERSIONS:
            found, accuracy, tpr = average[version]
            rows.append((title, version, found, accuracy, tpr, *[None] * 5))
    return Table(
        "regions",
        "Regions: all tasks together",
        (
            "views",
            "reasoning",
            "found",
            "accuracy",
            "precision (thesis: TPR)",
            "recall",
            "IoU",
            f"good (IoU ≥ {GOOD_IOU})",
            "grasp in region",
            "refused, not afforded",
        ),
        tuple(rows),
        _WORDS,
    )


def by_task(asked: Sequence[Asked], name: str, source: str) -> Table:
    """Return one line for each task, class and version, in the order of Table 6.3.

    `asked` holds the tasks that are afforded. Where the classes of the objects
    are known, Table 6.3 stands beside; where not, Table 6.4, whose objects the
    rules were not made for either.
    """
    classes_known = any(each.class_name for each in asked)
    beside = {
        (line.task, line.class_name if classes_known else "", line.reasoning): line
        for line in (TABLE_6_3 if classes_known else TABLE_6_4)
    }
    order = {key[:2]: index for index, key in enumerate(beside)}
    groups = sorted(
        dict.fromkeys((each.task, each.class_name) for each in asked),
        key=lambda group: (order.get(group, len(order)), group),
    )
    rows: list[tuple[Cell, ...]] = []
    for task, class_name in groups:
        for version in VERSIONS:
            mine = [
                each
                for each in asked
                if (each.task, each.class_name, each.reasoning) == (task, class_name, version)
            ]
            if not mine:
                continue
            found, accuracy, precision, recall, iou, good = _scores(mine)
            line = beside.get((task, class_name, version))
            rows.append(
                (
                    task,
                    class_name or None,
                    version,
                    found,
                    line.found if line else None,
                    accuracy,
                    line.accuracy if line else None,
                    precision,
                    line.tpr if line else None,
                    recall,
                    iou,
                    good,
                )
            )
    table = "Table 6.3" if classes_known else "Table 6.4, three YCB objects"
    return Table(
        name,
        f"Regions by task: {source}, beside the thesis's {table}",
        (
            "task",
            "class",
            "reasoning",
            "found",
            "thesis found",
            "accuracy",
            "thesis accuracy",
            "precision",
            "thesis 'TPR'",
            "recall",
            "IoU",
            "good",
        ),
        tuple(rows),
        _WORDS,
    )


def by_object(asked: Sequence[Asked], name: str, source: str) -> Table:
    """Return one line for each object, task and version."""
    keys = dict.fromkeys((each.thing, each.task, each.reasoning) for each in asked)
    rows = tuple(
        (
            thing,
            task,
            version,
            *_scores(mine),
            Share.of(each.grasp_in_region for each in mine),
        )
        for thing, task, version in sorted(keys)
        for mine in [
            [row for row in asked if (row.thing, row.task, row.reasoning) == (thing, task, version)]
        ]
    )
    return Table(
        name,
        f"Regions by object: {source}",
        (
            "object",
            "task",
            "reasoning",
            "found",
            "accuracy",
            "precision",
            "recall",
            "IoU",
            "good",
            "grasp in region",
        ),
        rows,
        detail=True,
    )


def _scores(asked: Sequence[Asked]) -> tuple[Share, MeanStd, MeanStd, MeanStd, MeanStd, Share]:
    """Return found, accuracy, precision, recall, IoU and good."""
    scores = [each.score for each in asked if each.score]
    return (
        Share.of(each.found for each in asked),
        MeanStd.of(score.accuracy for score in scores),
        MeanStd.of(score.precision for score in scores),
        MeanStd.of(score.recall for score in scores),
        MeanStd.of(score.iou for score in scores),
        Share.of(each.good for each in asked),
    )
