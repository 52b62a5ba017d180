"""The tables and the plot of experiment 3."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from experiments.framework import Asked, Plot, Share, Table
from experiments.framework.asking import VERSION_NAMES, VERSIONS
from experiments.framework.cells import Cell
from experiments.framework.plots import COLOURS, THESIS, new_figure, share_bars
from experiments.framework.thesis import TABLE_6_5
from experiments.grasps.blind import BLIND

METHODS = {BLIND: "task-blind", **VERSION_NAMES}


def headline(asked: Sequence[Asked], whole: Share) -> Table:
    """Return the lines of Table 6.5, ours beside them, and all tasks of each set of views."""
    rows: list[tuple[Cell, ...]] = []
    for (task, class_name), thesis in TABLE_6_5.items():
        mine = [each for each in asked if (each.task, each.class_name) == (task, class_name)]
        if mine:
            rows.append((task, class_name, *_beside(mine, thesis)))
    rows.extend(
        ("all tasks", source, *_beside([each for each in asked if each.source == source], {}))
        for source in dict.fromkeys(each.source for each in asked)
    )
    return Table(
        "grasps",
        "The chosen grasp is on the right part, beside the thesis's Table 6.5",
        (
            "task",
            "objects",
            "task-blind",
            "thesis data-driven",
            "v1",
            "thesis v1",
            "v2",
            "thesis v2",
        ),
        tuple(rows),
        "Counted over all views; no grasp is no success. Task-blind: the grasp with the highest "
        "score on the whole object, asked for through a task that avoids an affordance which no "
        f"part has; the whole object was offered in {whole.text()} of the views, in the others "
        "without the parts of one affordance. The thesis: one pan and one bottle, 10 views each.",
    )


def answered_table(asked: Sequence[Asked]) -> Table:
    """Return how each version compares with the blind grasp where it has a grasp."""
    rows = []
    for source in dict.fromkeys(each.source for each in asked):
        own = [each for each in asked if each.source == source]
        for version in VERSIONS:
            total = sum(each.reasoning == version for each in own)
            right, blind = where_answered(own, version)
            rows.append((source, version, Share(right.total, total), right, blind))
    return Table(
        "grasps-answered",
        "The same, where the version has a grasp at all",
        ("views", "reasoning", "has a grasp", "right part", "task-blind on the same views"),
        tuple(rows),
    )


def by_task(asked: Sequence[Asked]) -> Table:
    """Return one line for each set of views, task and class."""
    keys = dict.fromkeys((each.source, each.task, each.class_name) for each in asked)
    rows = []
    for source, task, class_name in sorted(keys):
        mine = [
            each
            for each in asked
            if (each.source, each.task, each.class_name) == (source, task, class_name)
        ]
        cells = [
            cell for method in METHODS for cell in (success(mine, method), _any_grasp(mine, method))
        ]
        rows.append((source, task, class_name or None, *cells))
    return Table(
        "grasps-by-task",
        "The chosen grasp is on the right part, by task",
        (
            "views",
            "task",
            "class",
            "task-blind",
            "any grasp",
            "v1",
            "any grasp v1",
            "v2",
            "any grasp v2",
        ),
        tuple(rows),
        "Any grasp: the answer holds a grasp at all.",
        detail=True,
    )


def success(asked: Sequence[Asked], method: str) -> Share:
    """Return how often the best grasp of a method is on the right part."""
    return Share.of(each.grasp_in_region for each in asked if each.reasoning == method)


def where_answered(asked: Sequence[Asked], version: str) -> tuple[Share, Share]:
    """Return the success of a version where it has a grasp, and the blind one's on these views."""
    by_key = {(*_view_of(each), each.reasoning): each for each in asked}
    answered = [each for each in asked if each.reasoning == version and each.grasped]
    blind = [by_key[(*_view_of(each), BLIND)] for each in answered]
    return (
        Share.of(each.grasp_in_region for each in answered),
        Share.of(each.grasp_in_region for each in blind),
    )


def _beside(asked: Sequence[Asked], thesis: Mapping[str, Share]) -> list[Cell]:
    return [cell for method in METHODS for cell in (success(asked, method), thesis.get(method))]


def _any_grasp(asked: Sequence[Asked], method: str) -> Share:
    return Share.of(each.grasped for each in asked if each.reasoning == method)


def _view_of(asked: Asked) -> tuple[str, str, str, str]:
    return asked.source, asked.thing, asked.view, asked.task


def bars(asked: Sequence[Asked]) -> Plot:
    """Draw how often each method is right, by task, on the first set of views."""
    first = asked[0].source
    own = [each for each in asked if each.source == first]
    tasks = sorted(dict.fromkeys(each.task for each in own))
    figure = new_figure(9.0, 3.8)
    axes = figure.subplots()
    share_bars(
        axes,
        tasks,
        {
            name: [success([each for each in own if each.task == task], method) for task in tasks]
            for method, name in METHODS.items()
        },
        colours={METHODS[BLIND]: THESIS, **COLOURS},
    )
    figure.legend(loc="outside upper center", ncols=3, fontsize=9, frameon=False)
    return Plot(
        "grasps",
        f"Views ({first}) in which the best grasp is on the part that is right for the task; "
        "whiskers are 95 % intervals.",
        figure,
    )
