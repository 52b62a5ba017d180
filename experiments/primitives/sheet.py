"""The worst views, to be studied: the labelled region beside the parts that were found."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.patches import Patch
from numpy.typing import NDArray

from experiments.framework import Context, Plot, ShownView, ViewSet
from experiments.framework.asking import mapped
from experiments.framework.gallery import MISSED, REST, grey, window
from experiments.framework.plots import new_figure
from experiments.framework.views import load
from experiments.primitives.cut import ask_parts
from experiments.primitives.model import Cut
from shared.schemas.primitive import Method

WORST = 20
_COLUMNS = 4
PARTS = tuple(to_rgb(f"C{index}") for index in range(10))
"""Of the parts by id; they come again after ten."""
LOST = (0.25, 0.25, 0.25)
"""Points of the object that are no part's."""

Labels = NDArray[np.int16]


def worst_views(cuts: Sequence[Cut], method: Method, count: int = WORST) -> list[Cut]:
    """Return the views, at most one of each file, whose worst region has the least IoU."""
    own = [each for each in cuts if each.method == method and each.regions]
    return sorted(own, key=lambda each: each.worst.single)[:count]


def contact_sheet(context: Context, sets: Sequence[ViewSet], worst: Sequence[Cut]) -> Plot:
    """Draw views side by side with their parts; the backend is asked for them again.

    Parameters
    ----------
    context : Context
    sets : sequence of ViewSet
        That the views are from.
    worst : sequence of Cut
        At least one; of one method.
    """
    files = {
        (views.name, file.object_name, str(file.number)): file
        for views in sets
        for file in views.files
    }

    def again(each: Cut) -> tuple[ShownView, Labels | None]:
        view = load(files[each.source, each.thing, each.view])
        if each.code:
            return view, None
        result = ask_parts(context.sparge, view, each.method)
        return view, result.point_primitive.reshape(view.view.label.shape)

    answers = mapped(
        again,
        worst,
        workers=context.workers,
        console=context.console,
        describe="drawing the worst views",
    )
    rows = -(-len(worst) // _COLUMNS)
    figure = new_figure(3.0 * _COLUMNS, 2.0 * rows + 0.4)
    grid = figure.subplots(rows, 2 * _COLUMNS, squeeze=False)
    for axes in grid.ravel():
        axes.set_axis_off()
    pairs = grid.reshape(-1, 2)
    for (left, right), each, (view, parts) in zip(pairs, worst, answers, strict=False):
        _draw(left, right, each, view, parts)
    figure.legend(
        handles=[
            Patch(color=MISSED, label="labelled region"),
            Patch(color=REST, label="rest of the object"),
            Patch(color=LOST, label="no part"),
        ],
        loc="outside lower center",
        ncols=3,
        fontsize=9,
        frameon=False,
    )
    return Plot(
        f"worst-{worst[0].method}",
        f"The {len(worst)} views in which a labelled region is met least by a single part "
        f"({worst[0].method}): the region, and beside it the parts, each in a colour.",
        figure,
    )


def _draw(left: Axes, right: Axes, each: Cut, view: ShownView, parts: Labels | None) -> None:
    region = each.worst
    on_object = view.view.on_object
    found = np.full(on_object.shape, -1, dtype=np.int16) if parts is None else parts
    label, cut = grey(view), grey(view)
    label[on_object] = REST
    label[on_object & view.view.region(region.task)] = MISSED
    cut[on_object] = LOST
    for part in np.unique(found[found >= 0]):
        cut[found == part] = PARTS[part % len(PARTS)]
    shown = window(on_object)
    for axes, picture in ((left, label), (right, cut)):
        axes.imshow(picture[shown], interpolation="nearest")
    left.set_title(f"{each.thing} {each.view}, {each.source}", fontsize=7)
    right.set_title(
        each.code or f"{region.task}: {region.single:.2f} of {region.union:.2f}", fontsize=7
    )
