"""The grasps that failed, to be studied: where the hand was, and what went wrong."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from experiments.framework import Plot, ShownView, ViewSet
from experiments.framework.gallery import MISSED, REST, grey, window
from experiments.framework.plots import new_figure
from experiments.framework.views import load
from experiments.grasps.judged import Judged
from shared.geometry.se3 import matrix_from_pose, transform_points
from shared.schemas.gripper import ParallelGripper

Array = NDArray[np.float64]

SHOWN = 24
_COLUMNS = 6
_HAND = "#C2352B"
_APPROACH = "#2F6DB5"


def failed(judged: Sequence[Judged], method: str = "v2", count: int = SHOWN) -> list[Judged]:
    """Return failed trials of a method, at most `count`.

    Every outcome and object comes before any of them comes twice, so that the sheet
    shows kinds of failures and not one object's.
    """
    own = [
        each for each in judged if each.tried and not each.held and each.asked.reasoning == method
    ]
    seen: Counter[tuple[str, str]] = Counter()
    ranked = []
    for order, each in enumerate(own):
        key = (each.outcome or "", each.asked.thing)
        ranked.append((seen[key], order, each))
        seen[key] += 1
    return [each for _, _, each in sorted(ranked, key=lambda item: item[:2])[:count]]


def failure_sheet(
    sets: Sequence[ViewSet], failures: Sequence[Judged], hand: ParallelGripper
) -> Plot:
    """Draw failed trials side by side, with the hand where it closed.

    Parameters
    ----------
    sets : sequence of ViewSet
        That the views are from.
    failures : sequence of Judged
        At least one.
    hand : ParallelGripper
        To be drawn.
    """
    files = {
        (views.name, file.object_name, str(file.number)): file
        for views in sets
        for file in views.files
    }
    rows = -(-len(failures) // _COLUMNS)
    figure = new_figure(2.3 * _COLUMNS, 2.2 * rows + 0.5)
    grid = figure.subplots(rows, _COLUMNS, squeeze=False)
    for axes in grid.ravel():
        axes.set_axis_off()
    for axes, each in zip(grid.ravel(), failures, strict=False):
        asked = each.asked
        _draw(axes, each, load(files[asked.source, asked.thing, asked.view]), hand)
    figure.legend(
        handles=[
            Patch(color=MISSED, label="labelled region"),
            Patch(color=REST, label="rest of the object"),
            Line2D([], [], color=_HAND, label="hand"),
            Line2D([], [], color=_APPROACH, label="approach"),
        ],
        loc="outside lower center",
        ncols=4,
        fontsize=9,
        frameon=False,
    )
    return Plot(
        "failed-grasps",
        f"{len(failures)} of the trials that failed (Version 2), each outcome and object once "
        "before any comes again.",
        figure,
    )


def _draw(axes: Axes, each: Judged, view: ShownView, hand: ParallelGripper) -> None:
    on_object = view.view.on_object
    picture = grey(view)
    picture[on_object] = REST
    picture[on_object & view.view.region(each.asked.task)] = MISSED
    around = on_object.copy()
    lines = []
    if each.grasp is not None:
        lines = [_pixels(line, view) for line in hand_lines(each.grasp, hand)]
        for u, v in np.vstack(lines).round().astype(int):
            if 0 <= v < around.shape[0] and 0 <= u < around.shape[1]:
                around[v, u] = True
    shown = window(around)
    axes.imshow(picture[shown], interpolation="nearest")
    for line, colour in zip(lines, (_HAND, _APPROACH), strict=False):
        for start, end in pairwise(line):
            axes.plot(
                [start[0] - shown[1].start, end[0] - shown[1].start],
                [start[1] - shown[0].start, end[1] - shown[0].start],
                color=colour,
                lw=1.6,
                scalex=False,
                scaley=False,
            )
    where = "right part" if each.asked.grasp_in_region else "wrong part"
    outcome = (each.outcome or "").replace("_", " ")
    axes.set_title(
        f"{each.asked.thing} {each.asked.view}, {each.asked.task}\n{outcome}, {where}", fontsize=7
    )


def hand_lines(grasp: Array, hand: ParallelGripper) -> tuple[Array, Array]:
    """Return the outline of both fingers and the palm (5, 3), and the approach (2, 3).

    In the frame of the grasp row (9,), metres: finger tip, finger, palm, finger, tip.
    """
    frame_from_grasp = matrix_from_pose(grasp[:3], grasp[3:7])
    half = max(float(grasp[7]), 0.004) / 2
    tip, root = hand.tip_beyond_tcp, hand.tip_beyond_tcp - hand.finger_length
    outline = np.array(
        [[0, -half, tip], [0, -half, root], [0, 0, root], [0, half, root], [0, half, tip]]
    )
    approach = np.array([[0, 0, root - 0.05], [0, 0, root]])
    return transform_points(frame_from_grasp, outline), transform_points(frame_from_grasp, approach)


def _pixels(points: Array, view: ShownView) -> Array:
    """Return where points (N, 3) of the camera's frame are in the image (N, 2)."""
    projected = points @ view.view.intrinsics.T
    return np.asarray(projected[:, :2] / projected[:, 2:])
