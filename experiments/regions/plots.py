"""The plots of experiment 2."""

from __future__ import annotations

from collections.abc import Sequence

from experiments.framework import Asked, Plot, Share
from experiments.framework.asking import VERSION_NAMES
from experiments.framework.plots import COLOURS, cumulative, iou_frame, new_figure, share_bars
from experiments.framework.scoring import GOOD_IOU
from experiments.framework.thesis import TABLE_6_3


def bars(asked: Sequence[Asked], source: str, index: int) -> Plot:
    """Draw found and good by task, the thesis's share of found beside."""
    own = [each for each in asked if each.source == source and each.afforded]
    tasks = sorted(dict.fromkeys(each.task for each in own))
    figure = new_figure(9.0, 5.6)
    top, bottom = figure.subplots(2, 1, sharex=True)
    found = {
        name: [_share(own, task, version, "found") for task in tasks]
        for version, name in VERSION_NAMES.items()
    }
    good = {
        name: [_share(own, task, version, "good") for task in tasks]
        for version, name in VERSION_NAMES.items()
    }
    beside = {
        name: [_thesis_found(task, version) for task in tasks]
        for version, name in VERSION_NAMES.items()
    }
    share_bars(top, tasks, found, beside=beside)
    share_bars(bottom, tasks, good)
    top.set_title(f"{source}: a region was found")
    bottom.set_title(f"the region is good: IoU ≥ {GOOD_IOU}")
    handles, labels = top.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=9, frameon=False)
    return Plot(
        f"found-and-good-{index}",
        f"Views ({source}) in which a region was found, and in which it is the right one. "
        "Whiskers are 95 % intervals, diamonds the thesis's share of found (Table 6.3).",
        figure,
    )


def _share(asked: Sequence[Asked], task: str, version: str, what: str) -> Share:
    return Share.of(
        getattr(each, what) for each in asked if (each.task, each.reasoning) == (task, version)
    )


def _thesis_found(task: str, version: str) -> float | None:
    lines = [each.found for each in TABLE_6_3 if (each.task, each.reasoning) == (task, version)]
    if not lines:
        return None
    return sum(each.count for each in lines) / sum(each.total for each in lines)


def distribution(asked: Sequence[Asked]) -> Plot:
    """Draw which share of the views reaches an IoU."""
    figure = new_figure(9.0, 3.8)
    axes = figure.subplots()
    sources = list(dict.fromkeys(each.source for each in asked))
    for line, source in zip(("-", "--", ":", "-."), sources, strict=False):
        for version, name in VERSION_NAMES.items():
            own = [
                each
                for each in asked
                if each.afforded and (each.source, each.reasoning) == (source, version)
            ]
            values = [each.score.iou for each in own if each.score]
            cumulative(
                axes,
                values,
                len(own),
                color=COLOURS[name],
                linestyle=line,
                label=f"{source}, {name}",
            )
    iou_frame(axes, GOOD_IOU, "views")
    return Plot(
        "iou",
        "How much predicted and labelled region overlap: the share of all views that reach an "
        f"IoU. The line marks {GOOD_IOU}, from which a view counts as good.",
        figure,
    )
