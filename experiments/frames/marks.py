"""Axes, dimensions and labels of a technical drawing in the plane, metres."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

from experiments.frames.hand import Hand

COLOURS = {"x": "#c8102e", "y": "#2e8b2e", "z": "#1f4fbf"}
INK = "#222222"
PART: dict[str, Any] = {"facecolor": "#f2c48d", "edgecolor": "#9a6a2f", "lw": 1.2}
AXIS = 0.035
"""Length of an axis."""
_ABOVE = 10
_PAPER: dict[str, Any] = {"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.5}


def prepare(ax: Axes, limits: tuple[float, float, float, float], title: str) -> None:
    """Prepare an empty part of the drawing, with one scale along both axes."""
    ax.set_xlim(limits[0], limits[1])
    ax.set_ylim(limits[2], limits[3])
    ax.set_aspect("equal")
    ax.axis("off")
    ax.set_title(title, fontsize=12, fontweight="bold", loc="left")


def draw_tcp_axes(ax: Axes, hand: Hand) -> None:
    """Draw the grasp frame: +z approaches, +y closes, +x goes into the page."""
    y, z = hand.place([[1.0, 0.0], [0.0, 1.0]]) - hand.place([[0.0, 0.0]])
    draw_axis(ax, hand.tcp, y, "y", AXIS + hand.opening / 4)
    draw_axis(ax, hand.tcp, z, "z", AXIS)
    draw_axis_across(ax, hand.tcp, "x", -(y + z) / np.sqrt(2), into=True)


def draw_axis(ax: Axes, origin: ArrayLike, direction: ArrayLike, name: str, length: float) -> None:
    """Draw an axis that lies in the plane of the drawing, with its name at the tip."""
    start, along = np.asarray(origin), np.asarray(direction)
    arrow = {"arrowstyle": "-|>", "color": COLOURS[name], "lw": 2.4, "shrinkA": 0}
    ax.annotate(
        "", xy=tuple(start + length * along), xytext=tuple(start), arrowprops=arrow, zorder=_ABOVE
    )
    _letter(ax, start + (length + 0.006) * along, name)


def draw_axis_across(
    ax: Axes, origin: ArrayLike, name: str, towards: ArrayLike, *, into: bool, size: float = 0.0045
) -> None:
    """Draw an axis that is perpendicular to the drawing: a cross goes into it, a dot comes out."""
    x, y = np.asarray(origin)
    ax.plot(x, y, "o", ms=10, mfc="white", mec=COLOURS[name], mew=1.8, zorder=_ABOVE + 1)
    mark = {"marker": "x", "ms": 5.5} if into else {"marker": "o", "ms": 3.5}
    ax.plot(x, y, color=COLOURS[name], mew=1.8, zorder=_ABOVE + 2, **mark)  # type: ignore[arg-type]
    _letter(ax, np.asarray(origin) + 2.6 * size * np.asarray(towards), name)


def draw_dimension(
    ax: Axes, start: ArrayLike, end: ArrayLike, text: str, *, aside: ArrayLike, ha: str
) -> None:
    """Draw a dimension line between two points, its text beside its middle."""
    a, b = np.asarray(start), np.asarray(end)
    arrow = {"arrowstyle": "<->", "color": INK, "lw": 1.1, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", xy=tuple(b), xytext=tuple(a), arrowprops=arrow, zorder=_ABOVE)
    x, y = (a + b) / 2 + np.asarray(aside)
    ax.text(x, y, text, color=INK, fontsize=9.5, zorder=_ABOVE, ha=ha, va="center", bbox=_PAPER)


def draw_level(
    ax: Axes, points: NDArray[np.float64], linestyle: str | tuple[int, tuple[int, int]] = "-"
) -> None:
    """Draw a thin line through points (N, 2), as a dimension's extension."""
    ax.plot(points[:, 0], points[:, 1], color="#888888", lw=0.8, linestyle=linestyle)


def draw_label(
    ax: Axes, text: str, at: ArrayLike, beside: ArrayLike, *, align: str = "left"
) -> None:
    """Draw a label with a thin line to what it names."""
    ax.annotate(
        text,
        xy=tuple(np.asarray(at)),
        xytext=tuple(np.asarray(beside)),
        fontsize=10,
        ha=align,
        va="center",
        color=INK,
        bbox=_PAPER,
        arrowprops={"arrowstyle": "-", "color": "#666666", "lw": 0.9, "shrinkB": 3},
        zorder=_ABOVE - 1,
    )


def _letter(ax: Axes, at: NDArray[np.float64], name: str) -> None:
    x, y = at
    written = ax.text(x, y, name, fontsize=11, fontweight="bold", ha="center", va="center")
    written.set(color=COLOURS[name], zorder=_ABOVE + 3)
