"""Objects side by side, coloured by what a gripper should hold."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from io import BytesIO

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from experiments.catalogue import CatalogueObject
from experiments.contact_sheet.shading import photograph

HANDOVER, OTHER = "handover", (0.72, 0.72, 0.70)
TASK_COLOUR, HANDOVER_COLOUR = (0.93, 0.55, 0.20), (0.30, 0.52, 0.80)
SHADES = (1.0, 0.80, 1.18, 0.65)
"""Parts of one region differ in brightness."""


def part_colours(thing: CatalogueObject) -> list[tuple[float, float, float]]:
    """Return one colour per part: orange to use it, blue to hand it over, grey for neither."""
    colours: list[tuple[float, float, float]] = []
    seen: Counter[tuple[float, float, float]] = Counter()
    for part in thing.parts:
        tasks = [task for task, held in thing.regions.items() if part.name in held]
        used = any(task != HANDOVER for task in tasks)
        base = TASK_COLOUR if used else HANDOVER_COLOUR if tasks else OTHER
        red, green, blue = np.clip(np.array(base) * SHADES[seen[base] % len(SHADES)], 0, 1)
        colours.append((float(red), float(green), float(blue)))
        seen[base] += 1
    return colours


def contact_sheet(things: Iterable[CatalogueObject], *, columns: int = 6, tile: int = 240) -> bytes:
    """Return the PNG of a sheet with one tile of `tile` pixels per object."""
    tiles = [(thing, photograph(thing, part_colours(thing), tile)) for thing in things]
    rows = -(-len(tiles) // columns)
    title, caption = 46, 42
    width, height = columns * tile, rows * (tile + caption) + title
    figure = Figure(figsize=(width / 100, height / 100), dpi=100, facecolor="white")
    FigureCanvasAgg(figure)
    for index, (thing, picture) in enumerate(tiles):
        row, column = divmod(index, columns)
        bottom = height - title - (row + 1) * (tile + caption) + caption
        axes = figure.add_axes(
            (column * tile / width, bottom / height, tile / width, tile / height)
        )
        axes.imshow(picture, interpolation="nearest")
        axes.set_axis_off()
        length = 1e3 * float(np.ptp(thing.vertices, axis=0).max())
        middle = (column + 0.5) * tile / width
        figure.text(middle, (bottom - 14) / height, thing.name, ha="center", fontsize=10)
        figure.text(
            middle,
            (bottom - 30) / height,
            f"{thing.description}, {length:.0f} mm",
            ha="center",
            fontsize=7,
            color="0.4",
        )
    for left, colour, text in (
        (20, TASK_COLOUR, "held to use it"),
        (170, HANDOVER_COLOUR, "held to hand it over"),
        (360, OTHER, "neither"),
    ):
        figure.text(left / width, 1 - 28 / height, "■", color=colour, fontsize=14)
        figure.text((left + 18) / width, 1 - 26 / height, text, fontsize=9)
    buffer = BytesIO()
    figure.savefig(buffer, format="png", metadata={"Software": None})
    return buffer.getvalue()
