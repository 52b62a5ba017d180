"""Pictures of answers: where the predicted region lies and where it should."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch
from numpy.typing import NDArray

from experiments.framework.asking import VERSION_NAMES, VERSIONS, Asked, mapped
from experiments.framework.experiment import Context, Plot
from experiments.framework.plots import new_figure
from experiments.framework.views import ShownView, ViewSet, load
from shared.client import GraspResult
from shared.schemas.task import Version

HIT, MISSED, WRONG, REST = (0.23, 0.56, 0.36), (0.95, 0.77, 0.25), (0.82, 0.27, 0.23), (0.72,) * 3
_COLUMNS, _MARGIN_PX = 4, 12


def draw_examples(context: Context, views: ViewSet, asked: Sequence[Asked]) -> list[Plot]:
    """Return one picture per version: examples from the best to the worst answer.

    The examples stand at equal steps in the order of their IoU, a region that
    was not found last, so that they show what is typical and are not picked.
    The backend is asked for them again.
    """
    plots = []
    for version in VERSIONS:
        own = [
            each
            for each in asked
            if each.afforded and (each.source, each.reasoning) == (views.name, version)
        ]
        own.sort(key=lambda each: -(each.score.iou if each.score else -1.0))
        steps = np.unique(np.linspace(0, len(own) - 1, 2 * _COLUMNS).round().astype(int))
        chosen = [own[k] for k in steps] if own else []
        if chosen:
            plots.append(_contact_sheet(context, views, chosen, version))
    return plots


def _contact_sheet(
    context: Context, views: ViewSet, chosen: Sequence[Asked], version: Version
) -> Plot:
    files = {(file.object_name, str(file.number)): file for file in views.files}

    def again(each: Asked) -> tuple[ShownView, GraspResult | None]:
        view = load(files[each.thing, each.view])
        if each.error:
            return view, None
        return view, context.sparge.grasp(
            view.arrays(), each.task, reasoning=version, max_grasps=0, explain=False
        )

    answers = mapped(
        again,
        chosen,
        workers=context.workers,
        console=context.console,
        describe="drawing examples",
    )
    rows = -(-len(chosen) // _COLUMNS)
    figure = new_figure(2.3 * _COLUMNS, 2.2 * rows + 0.5)
    grid = figure.subplots(rows, _COLUMNS, squeeze=False)
    for axes in grid.ravel():
        axes.set_axis_off()
    for axes, each, (view, result) in zip(grid.ravel(), chosen, answers, strict=False):
        _draw(axes, each, view, result)
    figure.legend(
        handles=[
            Patch(color=HIT, label="right"),
            Patch(color=WRONG, label="held, but should not"),
            Patch(color=MISSED, label="should be held"),
            Patch(color=REST, label="rest of the object"),
        ],
        loc="outside lower center",
        ncols=4,
        fontsize=9,
        frameon=False,
    )
    return Plot(
        f"examples-{version}",
        f"{VERSION_NAMES[version]} on {views.name}: examples at equal steps from the best answer "
        "to the worst.",
        figure,
    )


def _draw(axes: Axes, asked: Asked, view: ShownView, result: GraspResult | None) -> None:
    shape = view.view.label.shape
    predicted = np.zeros(shape, dtype=bool)
    if result is not None:
        predicted = result.point_region.reshape(shape)
    truth = view.view.region(asked.task)
    on_object = view.view.on_object
    picture = grey(view)
    picture[on_object] = REST
    picture[on_object & truth] = MISSED
    picture[predicted] = WRONG
    picture[predicted & truth] = HIT
    axes.imshow(picture[window(on_object | predicted)], interpolation="nearest")
    score = f"IoU {asked.score.iou:.2f}" if asked.score else "nothing found"
    axes.set_title(f"{asked.thing} {asked.view}, {asked.task}\n{score}", fontsize=8)


def grey(view: ShownView) -> NDArray[np.float64]:
    """Return the depth image (H, W, 3) as light greys, near is lighter."""
    depth = view.view.depth.astype(np.float64)
    seen = depth > 0
    low, high = (depth[seen].min(), depth[seen].max()) if seen.any() else (0.0, 1.0)
    grey = np.where(seen, 0.97 - 0.25 * (depth - low) / max(high - low, 1.0), 1.0)
    return np.repeat(grey[..., None], 3, axis=2)


def window(mask: NDArray[np.bool_]) -> tuple[slice, slice]:
    """Return the rows and columns around the pixels of a mask (H, W), with a margin."""
    rows, columns = np.nonzero(mask)
    low = np.maximum([rows.min() - _MARGIN_PX, columns.min() - _MARGIN_PX], 0)
    high = np.array([rows.max(), columns.max()]) + _MARGIN_PX
    return slice(int(low[0]), int(high[0])), slice(int(low[1]), int(high[1]))
