"""The whole picture: parts on the left, what to hold and how on the right."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from numpy.typing import ArrayLike, NDArray

from services.cli.picture.gripper import Hand, draw_hand
from services.cli.picture.parts import draw_parts, list_parts, number_parts, vertices_of
from services.cli.picture.style import GRIPPER, OTHER_GRIPPER, SHADOW, TABLE
from services.cli.picture.view import View, shading
from shared.palette import NO_PART, REGION, REST, part_colour
from shared.schemas.primitive import Primitive

Array = NDArray[np.float64]

MAX_POINTS = 15_000
MAX_GRIPPERS = 5
LINE = 150
"""Characters of a line under the title."""


def draw_answer(
    path: Path,
    points: Array,
    point_primitive: NDArray[np.integer],
    point_region: NDArray[np.bool_],
    primitives: Sequence[Primitive],
    grasps: Array,
    up: ArrayLike,
    title: str,
    viewpoint: ArrayLike = (0.0, 0.0, 0.0),
    why: str = "",
) -> None:
    """Write a PNG: on the left the recovered parts, on the right where to hold and how.

    Without a region or without grasps it shows what there is and says what is
    missing.

    Parameters
    ----------
    path : Path
        The file; its folder is made if it is missing.
    points : (N, 3) array
        The object's points in metres; non-finite rows are left out.
    point_primitive : (N,) array of int
        Id of each point's primitive, -1 for none.
    point_region : (N,) array of bool
        Which points are in the grasp region.
    primitives : sequence of Primitive
        In the points' frame.
    grasps : (G, 9) array
        x y z qx qy qz qw width score, best first.
    up : (3,) array_like
        Against gravity, in the points' frame.
    title : str
        Above the picture.
    viewpoint : (3,) array_like
        Position of the sensor; the picture is seen from its side.
    why : str
        A sentence or two under the title.
    """
    shown = _thinned(np.flatnonzero(np.isfinite(points).all(axis=1)))
    cloud, part = points[shown], point_primitive[shown]
    region = point_region[shown].astype(bool)
    hands = [Hand.of(row) for row in grasps[:MAX_GRIPPERS]]
    view = View.of(
        cloud, primitives, hands[0].fork if hands else None, up, np.asarray(viewpoint, dtype=float)
    )
    light = shading(cloud, view, np.asarray(viewpoint, dtype=float))
    colour_of = {each.id: part_colour(k) for k, each in enumerate(primitives)}

    figure = Figure(figsize=(13.0, 6.6), dpi=120, facecolor="white")
    FigureCanvasAgg(figure)
    figure.suptitle(title, fontsize=17, fontweight="bold", y=0.97)
    lines = "\n".join(textwrap.wrap(why, LINE, max_lines=2, placeholder=" ..."))
    figure.text(0.5, 0.895, lines, ha="center", va="center", fontsize=11.5, color="#444444")
    left, right = (figure.add_axes((x, 0.11, 0.48, 0.7)) for x in (0.01, 0.51))
    limits = view.limits([cloud, *(each.corners for each in hands), *map(vertices_of, primitives)])
    for axes, x, heading in ((left, 0.25, "recovered parts"), (right, 0.75, "where to hold")):
        _set_scene(axes, view, cloud, limits)
        figure.text(x, 0.82, heading, ha="center", fontsize=13, color="#444444")

    colours = [to_rgb(colour_of.get(int(each), NO_PART)) for each in part]
    draw_parts(left, view, primitives, colour_of, front=False)
    _draw_cloud(left, view, cloud, np.reshape(colours, (-1, 3)), light)
    draw_parts(left, view, primitives, colour_of, front=True)
    number_parts(left, view, primitives, colour_of)
    list_parts(figure, primitives, colour_of)

    held = dict.fromkeys(_mostly(part, region), REGION)
    draw_parts(right, view, primitives, held, front=False)
    _draw_cloud(right, view, cloud, np.where(region[:, None], to_rgb(REGION), to_rgb(REST)), light)
    draw_parts(right, view, primitives, held, front=True)
    for hand in reversed(hands[1:]):
        draw_hand(right, view, hand, cloud, OTHER_GRIPPER, width=1.4, opacity=0.5)
    for hand in hands[:1]:
        draw_hand(right, view, hand, cloud, GRIPPER, width=4.0, opacity=1.0)
    _say_what_is_held(figure, bool(region.any()), grasps)

    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, format="png", metadata={"Software": None})


def _thinned(rows: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return at most `MAX_POINTS` of the rows, the same every time."""
    if len(rows) <= MAX_POINTS:
        return rows
    return np.sort(np.random.default_rng(0).choice(rows, MAX_POINTS, replace=False))


def _mostly(part: NDArray[np.integer], region: NDArray[np.bool_]) -> list[int]:
    """Return the parts most of whose points are in the region."""
    return [int(each) for each in np.unique(part[part >= 0]) if region[part == each].mean() > 0.5]


def _set_scene(axes: Axes, view: View, cloud: Array, limits: tuple[Array, Array]) -> None:
    """Draw what both panels share: frame, table and the object's shadow on it."""
    (left, bottom), (right, top) = limits
    axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
    axes.set_axis_off()
    rim = view.flat(view.table(cloud))
    axes.add_patch(Polygon(rim, facecolor=TABLE, edgecolor="#D8D2C6", linewidth=0.8, zorder=0))
    x, y = view.flat(view.dropped(cloud)).T
    axes.scatter(x, y, s=10, c=SHADOW, linewidths=0, zorder=1)


def _draw_cloud(axes: Axes, view: View, cloud: Array, colours: Array, light: Array) -> None:
    order = np.argsort(view.nearness(cloud), kind="stable")
    shaded = np.clip(colours * light[:, None], 0, 1)
    x, y = view.flat(cloud[order]).T
    axes.scatter(x, y, s=7, c=shaded[order], linewidths=0, zorder=3)


def _say_what_is_held(figure: Figure, has_region: bool, grasps: Array) -> None:
    if not has_region:
        text = "no part of this object fits the task"
    elif not len(grasps):
        text = "there is a part to hold, but no grasp for it"
    else:
        best = f"best grasp: opening {1e3 * grasps[0, 7]:.0f} mm, score {grasps[0, 8]:.2f}"
        others = min(len(grasps), MAX_GRIPPERS) - 1
        text = f"{best}; the next {others} in thin lines" if others else best
    figure.text(0.75, 0.065, text, ha="center", va="center", fontsize=12)
