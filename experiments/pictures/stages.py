"""From points to a decision: one answer in four steps."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from experiments.pictures.pixels import NO_PART, coloured
from experiments.pictures.small import figure
from shared.client import GraspResult
from shared.schemas.task import TaskDefinition

Array = NDArray[np.float64]

PARTS = ((0.0, 0.45, 0.70), (0.90, 0.62, 0.0), (0.0, 0.62, 0.45), (0.80, 0.47, 0.65))
HELD = (0.84, 0.37, 0.0)
SIZE = 250


def draw_stages(
    depth: Array, focal: float, result: GraspResult, definition: TaskDefinition
) -> Figure:
    """Return a figure: the view, its parts, their labels with the task's relations, the region.

    Parameters
    ----------
    depth : (H, W) array
        Metres; 0 is no return.
    focal : float
        Pixels.
    result : GraspResult
        What the backend answered about this view.
    definition : TaskDefinition
        The task's relations.
    """
    part = result.point_primitive.reshape(depth.shape)
    region = result.point_region.reshape(depth.shape)
    seen = part >= 0
    plain = np.broadcast_to(np.array(NO_PART), (*depth.shape, 3))
    by_part = plain.copy()
    for each in result.answer.primitives:
        by_part[part == each.id] = PARTS[each.id % len(PARTS)]
    held = np.where(region[..., None], HELD, NO_PART)
    drawn = figure(4 * SIZE + 20, SIZE + 100)
    titles = ("1  points", "2  parts", "3  labels and relations", "4  decision")
    for index, colours in enumerate((plain, by_part, None, held)):
        axes = drawn.add_axes((index / 4 + 0.005, 0.20, 0.24, SIZE / (SIZE + 100)))
        axes.set_axis_off()
        axes.set_title(titles[index], fontsize=12, fontweight="bold")
        if colours is not None:
            axes.imshow(coloured(depth, focal, seen, colours, SIZE))
    _write_parts(drawn, result)
    _write_labels(drawn, result, definition)
    region_of = result.answer.region
    assert region_of is not None
    text = f"hold part {', '.join(map(str, region_of.primitive_ids))}\n"
    drawn.text(
        0.875, 0.05, f"{text}confidence {region_of.confidence:.2f}", ha="center", fontsize=10
    )
    drawn.text(0.125, 0.05, f"{int(seen.sum()):,} points\nof the object", ha="center", fontsize=10)
    return drawn


def _write_parts(drawn: Figure, result: GraspResult) -> None:
    for row, each in enumerate(result.answer.primitives):
        sizes = " x ".join(f"{1e3 * length:.0f}" for length in sorted(each.full_extents))
        drawn.text(
            0.375,
            0.115 - 0.06 * row,
            f"{each.id}: {each.shape_class}, {sizes} mm",
            ha="center",
            fontsize=10,
            color=PARTS[each.id % len(PARTS)],
        )


def _write_labels(drawn: Figure, result: GraspResult, definition: TaskDefinition) -> None:
    lines: list[tuple[str, object]] = []
    for each in result.answer.primitives:
        labels = ", ".join(each.labels) or "nothing"
        lines.append((f"part {each.id} counts as\n{labels}", PARTS[each.id % len(PARTS)]))
    relations = (
        ("requires", definition.requires),
        ("holds by", definition.grasp),
        ("leaves free", definition.avoids),
    )
    said = "\n".join(f"{name} {', '.join(what)}" for name, what in relations if what)
    lines.append((f"{definition.name}\n{said}", "#333333"))
    for row, (text, colour) in enumerate(lines):
        drawn.text(
            0.625,
            0.72 - 0.24 * row,
            text,
            ha="center",
            va="center",
            fontsize=11,
            color=colour,
            bbox={"boxstyle": "round,pad=0.45", "fc": "white", "ec": colour},
        )
