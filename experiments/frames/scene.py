"""The first part of the drawing: camera, object, and the hand before, at and after the grasp."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon, Rectangle
from numpy.typing import NDArray

from experiments.frames.hand import Hand
from experiments.frames.marks import (
    INK,
    PART,
    draw_axis,
    draw_axis_across,
    draw_label,
    draw_level,
    draw_tcp_axes,
    prepare,
)
from shared.schemas.gripper import ParallelGripper

PREGRASP_M = RETREAT_M = 0.10
"""The gateway's defaults, `SPARGE_GATEWAY_APPROACH_DISTANCE` and `..._RETREAT_DISTANCE`."""
APPROACH = np.array([np.sin(np.radians(60)), -np.cos(np.radians(60))])
UP = np.array([0.0, 1.0])

_Point = NDArray[np.float64]


def draw_scene(ax: Axes, gripper: ParallelGripper) -> None:
    """Draw a grasp, its pregrasp and its retreat in the camera's frame."""
    prepare(ax, (-0.40, 0.42, -0.095, 0.26), "1   A grasp in the frame of the view")
    ax.add_patch(Rectangle((-0.20, -0.075), 0.40, 0.010, facecolor="#c9c2b8", edgecolor="none"))
    ax.text(0.20, -0.080, "table", fontsize=10, ha="right", va="top")
    grasp, radius = np.array([0.0, 0.0]), 0.030
    ax.add_patch(Rectangle((-0.018, -0.065), 0.036, 0.05, **PART))
    ax.add_patch(Circle(tuple(grasp), radius, **PART))
    before, after = grasp - PREGRASP_M * APPROACH, grasp + RETREAT_M * UP
    for tcp in (before, after):
        _fork(ax, Hand(gripper, 2 * radius + 0.01, tcp, APPROACH), colour="#8a94a0", lw=2.0)
        ax.plot(*tcp, "o", ms=5, color="#555555", zorder=12)
    hand = Hand(gripper, 2 * radius, grasp, APPROACH)
    _fork(ax, hand, colour=INK, lw=4.0)
    _motion(ax, before, grasp)
    _motion(ax, grasp, after)
    draw_tcp_axes(ax, hand)
    draw_label(ax, "pose: the TCP\n(tool centre point)", grasp, (0.085, -0.02))
    draw_label(ax, "pregrasp: 0.10 m\nback along $-$z", before, (-0.22, 0.0), align="right")
    draw_label(ax, "retreat: 0.10 m\nalong scene.up", after, (0.07, 0.12))
    _camera(ax, np.array([0.30, 0.20]), np.radians(214))


def _fork(ax: Axes, hand: Hand, *, colour: str, lw: float) -> None:
    """Draw a hand as lines: two fingers and their root."""
    half, root = hand.opening / 2, hand.tip - hand.gripper.finger_length
    corners = [(-half, hand.tip), (-half, root), (half, root), (half, hand.tip)]
    ax.plot(*hand.place(corners).T, color=colour, lw=lw, solid_capstyle="round", zorder=6)


def _motion(ax: Axes, start: _Point, end: _Point) -> None:
    style = {"arrowstyle": "-|>", "color": "#e07b00", "lw": 2.0, "shrinkA": 3, "shrinkB": 6}
    ax.annotate("", xy=tuple(end), xytext=tuple(start), arrowprops=style, zorder=9)


def _camera(ax: Axes, at: _Point, heading: float) -> None:
    """Draw a camera and its optical frame: z looks, y is down in its picture, x to the right."""
    z = np.array([np.cos(heading), np.sin(heading)])
    y = np.array([-z[1], z[0]])
    corners = [at + along * z + side * y for along, side in ((-0.05, -0.02), (-0.05, 0.02))]
    corners += [at + side * y for side in (0.02, -0.02)]
    ax.add_patch(Polygon(corners, closed=True, facecolor="#3b4650", edgecolor="none"))
    for side in (-0.38, 0.38):
        draw_level(ax, np.array([at, at + 0.24 * (z + side * y)]), linestyle=(0, (1, 3)))
    draw_axis(ax, at, z, "z", 0.06)
    draw_axis(ax, at, y, "y", 0.05)
    draw_axis_across(ax, at, "x", (z - y) / np.sqrt(2), into=True, size=0.006)
    ax.text(at[0] - 0.005, at[1] + 0.062, "camera: frame_id,\nits optical frame", fontsize=10)
