"""The tables and the plot of robustness."""

from __future__ import annotations

from collections.abc import Sequence

from experiments.framework import MeanStd, Plot, Share, Table
from experiments.framework.asking import VERSION_NAMES, VERSIONS
from experiments.framework.cells import Cell
from experiments.framework.plots import COLOURS, new_figure, share_bars
from experiments.framework.scoring import GOOD_IOU
from experiments.robustness.disturbances import AS_IT_IS, CONDITIONS
from experiments.robustness.outcomes import Disturbed, Moved


def disturbances(outcomes: Sequence[Disturbed]) -> Table:
    """Return one line for each set of views, condition and version."""
    rows: list[tuple[Cell, ...]] = []
    for source in dict.fromkeys(each.asked.source for each in outcomes):
        for condition in CONDITIONS:
            for version in VERSIONS:
                mine = select(outcomes, source, condition, version)
                if not mine:
                    continue
                scores = [each.asked.score for each in mine if each.asked.score]
                same = [each.same for each in mine if each.same is not None]
                rows.append(
                    (
                        source,
                        condition,
                        version,
                        Share.of(each.asked.found for each in mine),
                        MeanStd.of(score.iou for score in scores),
                        Share.of(each.asked.good for each in mine),
                        None if condition == AS_IT_IS or not same else Share.of(same),
                    )
                )
    return Table(
        "robustness",
        "Regions under disturbances",
        ("views", "disturbance", "reasoning", "found", "IoU", "good", "same as undisturbed"),
        tuple(rows),
        "Noise x1 is the stereo model of the dataset (sigma 1.5 mm at 1 m, growing with the square "
        "of the depth, steps and edge drop-out stay as they are). Occluded: that share of the "
        "object's pixels is hidden beyond a straight edge; a view in which nothing of the right "
        "part is left does not count. Other size: the object alone, made as large as a random "
        "variant of its class, at the same place on the same table; only objects of the catalogue "
        f"can be. Same: the region overlaps that of the undisturbed view by {GOOD_IOU} or more, or "
        "both are empty.",
    )


def motions(outcomes: Sequence[Moved]) -> Table:
    """Return how much the region depends on the frame of the input; it should not at all."""
    rows: list[tuple[Cell, ...]] = []
    for source in dict.fromkeys(each.asked.source for each in outcomes):
        for version in VERSIONS:
            mine = [
                each
                for each in outcomes
                if (each.asked.source, each.asked.reasoning) == (source, version)
                and each.asked.known
            ]
            rows.append(
                (
                    source,
                    version,
                    Share.of(each.changed == 0 for each in mine),
                    sum(each.changed for each in mine) / max(sum(each.points for each in mine), 1),
                    max((each.changed / each.points for each in mine), default=0.0),
                    Share.of(each.flipped for each in mine),
                )
            )
    return Table(
        "rigid-motion",
        "The same cloud in another frame: random rotation and translation of the whole scene",
        (
            "views",
            "reasoning",
            "views without any change",
            "share of points that change",
            "largest share in a view",
            "found in one frame only",
        ),
        tuple(rows),
        "Points of the object that enter or leave the region when all points and the viewpoint "
        "are moved together. The region must not change at all.",
    )


def select(
    outcomes: Sequence[Disturbed], source: str, condition: str, version: str
) -> list[Disturbed]:
    """Return the answers of one source, condition and version."""
    return [
        each
        for each in outcomes
        if (each.asked.source, each.condition, each.asked.reasoning) == (source, condition, version)
    ]


def bars(outcomes: Sequence[Disturbed]) -> Plot:
    """Draw the share of good regions under every condition, on the first set of views."""
    source = outcomes[0].asked.source
    figure = new_figure(10.0, 3.8)
    axes = figure.subplots()
    share_bars(
        axes,
        [condition.replace(" ", "\n", 1) for condition in CONDITIONS],
        {
            name: [
                Share.of(each.asked.good for each in select(outcomes, source, condition, version))
                for condition in CONDITIONS
            ]
            for version, name in VERSION_NAMES.items()
        },
        colours=COLOURS,
    )
    figure.legend(loc="outside upper center", ncols=2, fontsize=9, frameon=False)
    return Plot(
        "robustness",
        f"Views ({source}) with the right region (IoU ≥ {GOOD_IOU}) under each disturbance; "
        "whiskers are 95 % intervals.",
        figure,
    )
