"""One picture of an answer: the parts, the part to hold, and the gripper that holds it.

A small orthographic projection of its own: everything is drawn in two
dimensions, farthest first, with no window and no global state.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb, to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.patheffects import withStroke
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from shared.geometry.rotation import frame_from_z, matrix_from_quaternion, unit
from shared.schemas.primitive import Primitive
from shared.superquadric import Superquadric, surface_mesh

Array = NDArray[np.float64]

MAX_POINTS = 15_000
MAX_GRIPPERS = 5
ELEVATION_DEG = 32.0
AZIMUTHS_DEG = (20.0, -20.0, 30.0, -30.0, 40.0, -40.0, 10.0, -10.0)
"""The picture is seen from the sensor's side, turned by one of these about the vertical."""

PART_COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#8C6D31", "#6A51A3")
NO_PART, REST, REGION = "#9A9A9A", "#C4C4C4", "#D55E00"
GRIPPER, OTHER_GRIPPER, TABLE, SHADOW = "#14213D", "#4F7CAC", "#F3F0EA", "#DDD7CB"

_RINGS, _SEGMENTS = 23, 48
_FINGER, _TIP, _WRIST, _ARROW = 0.045, 0.008, 0.030, 0.045
"""Lengths of the drawn gripper, metres: palm to grasp centre, tips beyond it, wrist, approach."""


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
    """
    shown = _thinned(np.flatnonzero(np.isfinite(points).all(axis=1)))
    cloud, part = points[shown], point_primitive[shown]
    region = point_region[shown].astype(bool)
    hands = [_hand(row) for row in grasps[:MAX_GRIPPERS]]
    view = _View.of(cloud, primitives, hands, up, np.asarray(viewpoint, dtype=float))
    light = _shading(cloud, view, np.asarray(viewpoint, dtype=float))
    colour_of = {each.id: PART_COLOURS[k % len(PART_COLOURS)] for k, each in enumerate(primitives)}

    figure = Figure(figsize=(13.0, 6.6), dpi=120, facecolor="white")
    FigureCanvasAgg(figure)
    figure.suptitle(title, fontsize=17, fontweight="bold", y=0.965)
    left, right = (figure.add_axes((x, 0.12, 0.48, 0.75)) for x in (0.01, 0.51))
    limits = view.limits([cloud, *(each.corners for each in hands), *map(_vertices, primitives)])
    for axes, x, heading in ((left, 0.25, "recovered parts"), (right, 0.75, "where to hold")):
        _set_scene(axes, view, cloud, limits)
        figure.text(x, 0.885, heading, ha="center", fontsize=13, color="#444444")

    colours = [to_rgb(colour_of.get(int(each), NO_PART)) for each in part]
    _draw_parts(left, view, primitives, colour_of, front=False)
    _draw_cloud(left, view, cloud, np.reshape(colours, (-1, 3)), light)
    _draw_parts(left, view, primitives, colour_of, front=True)
    _number_parts(left, view, primitives, colour_of)
    _list_parts(figure, primitives, colour_of)

    held = dict.fromkeys(_mostly(part, region), REGION)
    _draw_parts(right, view, primitives, held, front=False)
    _draw_cloud(right, view, cloud, np.where(region[:, None], to_rgb(REGION), to_rgb(REST)), light)
    _draw_parts(right, view, primitives, held, front=True)
    for hand in reversed(hands[1:]):
        _draw_hand(right, view, hand, OTHER_GRIPPER, width=1.4, opacity=0.5)
    for hand in hands[:1]:
        _draw_hand(right, view, hand, GRIPPER, width=4.0, opacity=1.0)
    _say_what_is_held(figure, bool(region.any()), grasps)

    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, format="png", metadata={"Software": None})


@dataclass(frozen=True)
class _Hand:
    """Lines of a gripper in the points' frame, metres: tip-palm-palm-tip, wrist, approach."""

    fork: Array
    wrist: Array
    approach: Array

    @property
    def corners(self) -> Array:
        return np.concatenate([self.fork, self.wrist, self.approach])


def _hand(grasp: Array) -> _Hand:
    rotation, half = matrix_from_quaternion(grasp[3:7]), grasp[7] / 2

    def placed(*corners: tuple[float, float]) -> Array:
        return np.array([[0.0, y, z] for y, z in corners]) @ rotation.T + grasp[:3]

    palm, wrist = -_FINGER, -_FINGER - _WRIST
    return _Hand(
        fork=placed((-half, _TIP), (-half, palm), (half, palm), (half, _TIP)),
        wrist=placed((0, palm), (0, wrist)),
        approach=placed((0, wrist - 0.008 - _ARROW), (0, wrist - 0.008)),
    )


@dataclass(frozen=True)
class _View:
    """From where the picture is seen.

    Attributes
    ----------
    axes : (3, 3) array
        Rows: to the right, upwards in the picture, towards the eye.
    ground : (3, 3) array
        Rows: away from the sensor, to its left, against gravity.
    centre : (3,) array
        Middle of the object.
    floor : float
        Height of the table above `centre`, metres (negative).
    """

    axes: Array
    ground: Array
    centre: Array
    floor: float

    @classmethod
    def of(
        cls,
        cloud: Array,
        primitives: Sequence[Primitive],
        hands: Sequence[_Hand],
        up: ArrayLike,
        sensor: Array,
    ) -> _View:
        """Return the view that shows most of the object and of the best gripper."""
        held = np.array([each.superquadric.position for each in primitives]).reshape(-1, 3)
        body = next((each for each in (cloud, held) if len(each)), np.zeros((1, 3)))
        centre = np.median(body, axis=0)
        z = unit(up) if np.linalg.norm(up) > 0 else np.array([0.0, 0.0, 1.0])
        ground = frame_from_z(z, x_hint=centre - sensor).T
        floor = float(np.percentile((body - centre) @ z, 0.5))
        views = [cls(_axes(ground, azimuth), ground, centre, floor) for azimuth in AZIMUTHS_DEG]
        return max(views, key=lambda view: view.shows(body, hands))

    def shows(self, body: Array, hands: Sequence[_Hand]) -> float:
        """Return how well the object and the best gripper's opening are seen from here."""
        length = float(np.linalg.norm(self.flat(body - np.median(body, axis=0) + self.centre), 2))
        if not hands:
            return length
        fork = hands[0].fork
        side = unit(np.cross(fork[1] - fork[0], fork[2] - fork[1]))
        return length * (0.5 + min(abs(float(side @ self.axes[2])), 0.5))

    def flat(self, points: Array) -> Array:
        """Return where points (..., 3) are in the picture (..., 2), metres."""
        return np.asarray((points - self.centre) @ self.axes[:2].T)

    def nearness(self, points: Array) -> Array:
        """Return how far points (..., 3) are towards the eye, metres."""
        return np.asarray((points - self.centre) @ self.axes[2])

    def dropped(self, points: Array) -> Array:
        """Return points (..., 3) moved straight down to the table."""
        up = self.ground[2]
        height = (points - self.centre) @ up - self.floor
        return np.asarray(points - height[..., None] * up)

    def table(self, cloud: Array) -> Array:
        """Return the corners (4, 3) of a piece of table under the cloud, along its length."""
        there = (cloud - self.centre) @ self.ground[:2].T if len(cloud) else np.zeros((1, 2))
        centred = there - there.mean(axis=0)
        turn = np.linalg.eigh(centred.T @ centred)[1]
        low, high = (there @ turn).min(axis=0) - 0.03, (there @ turn).max(axis=0) + 0.03
        rim = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
        flat = np.array(rim) @ turn.T
        return np.asarray(
            self.centre + np.column_stack([flat, np.full(4, self.floor)]) @ self.ground
        )

    def limits(self, things: Sequence[Array]) -> tuple[Array, Array]:
        """Return the lowest and highest corner (2,) in the picture of all these points."""
        everything = np.concatenate([self.flat(self.table(things[0])), *map(self.flat, things)])
        everything = everything[np.isfinite(everything).all(axis=1)]
        return everything.min(axis=0) - 0.006, everything.max(axis=0) + 0.006


def _axes(ground: Array, azimuth_deg: float) -> Array:
    """Return the picture's axes for an eye turned by the azimuth from the sensor's side."""
    azimuth, elevation = np.radians([azimuth_deg, ELEVATION_DEG])
    behind = -np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    eye = np.cos(elevation) * behind + np.sin(elevation) * np.array([0.0, 0.0, 1.0])
    right = unit(np.cross([0.0, 0.0, 1.0], eye))
    return np.array([right, np.cross(eye, right), eye]) @ ground


def _thinned(rows: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return at most `MAX_POINTS` of the rows, the same every time."""
    if len(rows) <= MAX_POINTS:
        return rows
    return np.sort(np.random.default_rng(0).choice(rows, MAX_POINTS, replace=False))


def _mostly(part: NDArray[np.integer], region: NDArray[np.bool_]) -> list[int]:
    """Return the parts most of whose points are in the region."""
    return [int(each) for each in np.unique(part[part >= 0]) if region[part == each].mean() > 0.5]


def _shading(cloud: Array, view: _View, sensor: Array) -> Array:
    """Return the brightness (N,) of each point, from the normal of its neighbourhood."""
    if len(cloud) < 16:
        return np.ones(len(cloud))
    _, neighbours = cKDTree(cloud).query(cloud, k=16)
    around = cloud[neighbours] - cloud[neighbours].mean(axis=1, keepdims=True)
    normals = np.linalg.eigh(np.swapaxes(around, 1, 2) @ around)[1][:, :, 0]
    normals *= np.sign(np.einsum("ij,ij->i", normals, sensor - cloud))[:, None]
    lamp = unit([-0.5, 0.75, 0.45]) @ view.axes
    return np.asarray(0.68 + 0.42 * np.clip(normals @ lamp, -0.6, 1.0))


def _vertices(primitive: Primitive) -> Array:
    return surface_mesh(primitive.superquadric, _RINGS, _SEGMENTS)[0]


def _wires(superquadric: Superquadric) -> list[Array]:
    """Return latitudes and longitudes of the surface as lines (K, 3)."""
    vertices, _ = surface_mesh(superquadric, _RINGS, _SEGMENTS)
    rings = vertices[1:-1].reshape(_RINGS, _SEGMENTS, 3)
    latitudes = [np.vstack([ring, ring[:1]]) for ring in rings[2::3]]
    longitudes = [
        np.vstack([vertices[:1], rings[:, k], vertices[-1:]]) for k in range(0, _SEGMENTS, 4)
    ]
    return latitudes + longitudes


def _set_scene(axes: Axes, view: _View, cloud: Array, limits: tuple[Array, Array]) -> None:
    """Draw what both panels share: frame, table and the object's shadow on it."""
    (left, bottom), (right, top) = limits
    axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
    axes.set_axis_off()
    rim = view.flat(view.table(cloud))
    axes.add_patch(Polygon(rim, facecolor=TABLE, edgecolor="#D8D2C6", linewidth=0.8, zorder=0))
    x, y = view.flat(view.dropped(cloud)).T
    axes.scatter(x, y, s=10, c=SHADOW, linewidths=0, zorder=1)


def _draw_cloud(axes: Axes, view: _View, cloud: Array, colours: Array, light: Array) -> None:
    order = np.argsort(view.nearness(cloud), kind="stable")
    shaded = np.clip(colours * light[:, None], 0, 1)
    x, y = view.flat(cloud[order]).T
    axes.scatter(x, y, s=7, c=shaded[order], linewidths=0, zorder=3)


def _draw_parts(
    axes: Axes,
    view: _View,
    primitives: Sequence[Primitive],
    colour_of: Mapping[int, str],
    *,
    front: bool,
) -> None:
    """Draw the wires that face the eye (`front`), or those behind the cloud."""
    for each in primitives:
        if each.id not in colour_of:
            continue
        solid, pieces = each.superquadric, []
        for line in _wires(solid):
            segments = np.stack([line[:-1], line[1:]], axis=1)
            local = solid.to_local(segments.mean(axis=1)) / np.square(solid.semi_axes)
            facing = (local @ solid.rotation.T) @ view.axes[2] > 0
            pieces.append(segments[facing == front])
        axes.add_collection(
            LineCollection(
                list(view.flat(np.concatenate(pieces))),
                colors=[to_rgba(_darker(colour_of[each.id]), 0.8 if front else 0.4)],
                linewidths=0.8 if front else 0.6,
                zorder=4 if front else 2,
            ),
            autolim=False,
        )


def _darker(colour: str) -> tuple[float, float, float]:
    red, green, blue = to_rgb(colour)
    return (0.6 * red, 0.6 * green, 0.6 * blue)


def _number_parts(
    axes: Axes, view: _View, primitives: Sequence[Primitive], colour_of: Mapping[int, str]
) -> None:
    for each in primitives:
        x, y = view.flat(np.array(each.superquadric.position))
        axes.text(
            x,
            y,
            str(each.id),
            ha="center",
            va="center",
            fontsize=12,
            fontweight="bold",
            color=_darker(colour_of[each.id]),
            bbox={"boxstyle": "circle,pad=0.2", "fc": "white", "ec": _darker(colour_of[each.id])},
            zorder=6,
        )


def _draw_hand(
    axes: Axes, view: _View, hand: _Hand, colour: str, *, width: float, opacity: float
) -> None:
    outline = [withStroke(linewidth=2 * width, foreground="white")] if opacity == 1 else []
    for line in (hand.fork, hand.wrist):
        axes.plot(
            *view.flat(line).T,
            color=colour,
            alpha=opacity,
            linewidth=width,
            solid_capstyle="round",
            solid_joinstyle="round",
            path_effects=outline,
            zorder=5,
        )
    if opacity == 1:
        start, end = view.flat(hand.approach)
        axes.annotate(
            "",
            xy=tuple(end),
            xytext=tuple(start),
            arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 2.2, "mutation_scale": 18},
            annotation_clip=False,
            zorder=5,
        )


def _list_parts(
    figure: Figure, primitives: Sequence[Primitive], colour_of: Mapping[int, str]
) -> None:
    handles = []
    for each in primitives:
        sizes = " × ".join(f"{1e3 * extent:.0f}" for extent in sorted(each.full_extents)[::-1])
        handles.append(
            Line2D(
                [],
                [],
                marker="o",
                linestyle="",
                markersize=8,
                color=colour_of[each.id],
                label=f"{each.id}  {each.shape_class}, {sizes} mm",
            )
        )
    if handles:
        figure.legend(
            handles=handles,
            loc="center",
            bbox_to_anchor=(0.25, 0.065),
            ncols=min(len(handles), 2),
            fontsize=11,
            frameon=False,
            handletextpad=0.3,
            columnspacing=1.6,
        )
    else:
        figure.text(0.25, 0.065, "no parts were recovered", ha="center", va="center", fontsize=12)


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
