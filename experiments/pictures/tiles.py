"""The gallery: every object as it is labelled, and what SPaRGE answers about a view of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from experiments.catalogue import CatalogueObject
from experiments.contact_sheet.shading import photograph
from experiments.contact_sheet.sheet import HANDOVER, HANDOVER_COLOUR, TASK_COLOUR, part_colours
from experiments.dataset import DEPTH_SCALE, LabelledView, make_view
from experiments.dataset.drop import body_of
from experiments.framework.scoring import score_region
from experiments.pictures.pixels import NO_PART, coloured
from experiments.pictures.small import figure, save_figure
from shared.client import Sparge

Array = NDArray[np.float64]

SIZE, CAPTION = 210, 26
SEED, VIEW = 1, 0
"""Of the views; the experiments draw with 0 unless they are told otherwise."""


def save_tiles(thing: CatalogueObject, sparge: Sparge, folder: Path) -> tuple[int, list[float]]:
    """Write a strip: the labelled object, then an answer per task; return bytes and IoUs."""
    view = make_view(body_of(thing), VIEW, SEED)
    pictures = [(f"{thing.name}", photograph(thing, part_colours(thing), SIZE))]
    ious = []
    for task in thing.tasks:
        region = _answered(sparge, view, task)
        seen = view.on_object
        iou = score_region(view.region(task)[seen], region[seen]).iou
        ious.append(iou)
        colour = HANDOVER_COLOUR if task == HANDOVER else TASK_COLOUR
        pixels = np.where(region[..., None], colour, NO_PART)
        depth = DEPTH_SCALE * view.depth.astype(np.float64)
        picture = coloured(depth, view.intrinsics[0, 0], seen, pixels, SIZE)
        pictures.append((f"{task}: IoU {iou:.2f}", picture))
    drawn = figure(SIZE * len(pictures), SIZE + CAPTION)
    for index, (caption, picture) in enumerate(pictures):
        left, width = index / len(pictures), 1 / len(pictures)
        height = SIZE / (SIZE + CAPTION)
        axes = drawn.add_axes((left + 0.006, 1 - height, width - 0.012, height))
        axes.imshow(picture, interpolation="nearest")
        axes.set_axis_off()
        drawn.text(left + width / 2, 0.35 * (1 - height), caption, ha="center", fontsize=10)
    return save_figure(drawn, folder / f"{thing.name}.webp"), ious


def _answered(sparge: Sparge, view: LabelledView, task: str) -> NDArray[np.bool_]:
    cloud: dict[str, ArrayLike] = {
        "depth": view.depth,
        "intrinsics": view.intrinsics,
        "depth_scale": np.array(DEPTH_SCALE),
    }
    result = sparge.grasp(cloud, task, max_grasps=0, explain=False)
    return result.point_region.reshape(view.depth.shape)
