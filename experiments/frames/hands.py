"""The other parts of the drawing: the Panda's hand, and a hand on a linkage."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon
from numpy.typing import NDArray

from experiments.frames.hand import Hand
from experiments.frames.marks import (
    AXIS,
    COLOURS,
    PART,
    draw_axis,
    draw_axis_across,
    draw_dimension,
    draw_label,
    draw_level,
    draw_tcp_axes,
    prepare,
)
from shared.grippers.kinematics import advance, choose_link, tcp_from_link
from shared.schemas.gripper import ParallelGripper

GHOST: dict[str, Any] = {
    "facecolor": "none",
    "edgecolor": "#6b7680",
    "lw": 1.1,
    "linestyle": (0, (4, 3)),
}
LIMITS = (-0.185, 0.185, -0.085, 0.235)


def draw_panda(ax: Axes, gripper: ParallelGripper) -> None:
    """Draw the Panda's hand with its links, and its flange from behind."""
    prepare(ax, LIMITS, f"2   {gripper.name}")
    hand = Hand(gripper, 0.05)
    _arm(ax, hand)
    hand.draw(ax)
    ax.add_patch(Circle((0, 0), 0.025, **PART))
    draw_tcp_axes(ax, hand)
    base, tip = -hand.base, -hand.tip
    ax.plot(0, base, "o", ms=6, color="#222222", zorder=12)
    draw_label(ax, "panda_hand and\npanda_link8, the flange", (0, base), (0.045, base + 0.05))
    draw_label(ax, "TCP = panda_hand_tcp", (0, 0), (0.055, -0.052))
    for height in (base, 0.0):
        draw_level(ax, np.array([(-0.135, height), (-0.005, height)]))
    text = f"{1000 * base:.1f} mm"
    draw_dimension(ax, (-0.125, 0), (-0.125, base), text, aside=(-0.006, 0), ha="right")
    draw_label(ax, f"tips {1000 * hand.tip:.1f} mm\nbeyond", (0.036, tip), (0.10, 0.015))
    _width(ax, hand)
    _turned_flange(ax, gripper, np.array([-0.125, 0.175]))


def draw_linkage(ax: Axes, gripper: ParallelGripper) -> None:
    """Draw a hand whose pads move forward as they close."""
    prepare(ax, LIMITS, f"3   {gripper.name}: the pads move forward as they close")
    hand = Hand(gripper, 0.04)
    forward = advance(gripper.urdf, hand.opening)
    opened = Hand(gripper, gripper.max_opening, (0.0, forward))
    _arm(ax, hand)
    opened.draw(ax, palm=False, **GHOST)
    hand.draw(ax)
    ax.add_patch(Circle((0, 0), 0.02, **PART))
    draw_tcp_axes(ax, hand)
    base = -hand.base
    _link_axes(ax, gripper, (0.0, base))
    draw_label(ax, choose_link(gripper, None).name, (0, base), (0.045, base + 0.05))
    draw_label(ax, "pads when open", (0.0625, 0.03), (0.085, 0.062))
    draw_label(ax, "TCP", (0, 0), (0.055, -0.052))
    for height in (base, forward, 0.0):
        draw_level(ax, np.array([(-0.155, height), (-0.005, height)]))
    text = f"{1000 * (base - forward):.1f} mm\nopen"
    draw_dimension(ax, (-0.088, forward), (-0.088, base), text, aside=(-0.003, 0.0), ha="right")
    text = f"{1000 * base:.1f} mm\nclosed on\n{1000 * hand.opening:.0f} mm"
    draw_dimension(ax, (-0.148, 0), (-0.148, base), text, aside=(-0.003, 0.03), ha="right")
    for height in (forward, 0.0):
        draw_level(ax, np.array([(0.06, height), (0.135, height)]))
    text = f"{1000 * forward:.1f} mm\nforward"
    draw_dimension(ax, (0.125, 0), (0.125, forward), text, aside=(0.006, 0), ha="left")
    _width(ax, hand)


def _link_axes(ax: Axes, gripper: ParallelGripper, at: tuple[float, float]) -> None:
    """Draw the first link's axes: two lie in the page, one does not."""
    rotation = tcp_from_link(gripper, choose_link(gripper, None), 0.0)[:3, :3]
    for name, (x, y, z) in zip("xyz", rotation.T, strict=True):
        if np.hypot(y, z) > abs(x):
            draw_axis(ax, at, np.array([y, -z]), name, AXIS)
        else:
            draw_axis_across(ax, at, name, (-0.7, 0.7), into=x > 0)


def _turned_flange(ax: Axes, gripper: ParallelGripper, centre: NDArray[np.float64]) -> None:
    """Draw hand and flange as seen from behind, along +z: y to the right, x up."""
    ax.add_patch(Circle(tuple(centre), 0.046, facecolor="#f6f7f9", edgecolor="#9aa4ae"))
    for name, dashes in (("panda_hand", "-"), ("panda_link8", (0, (2.5, 1.2)))):
        rotation = tcp_from_link(gripper, choose_link(gripper, name), 0.0)[:3, :3]
        for axis, (x, y, _) in zip("xy", rotation.T[:2], strict=True):
            direction = np.array([y, x])
            ax.annotate(
                "",
                xy=tuple(centre + 0.036 * direction),
                xytext=tuple(centre),
                arrowprops={
                    "arrowstyle": "-|>",
                    "color": COLOURS[axis],
                    "lw": 2.0,
                    "ls": dashes,
                    "shrinkA": 0,
                },
            )
            right, up = centre + 0.041 * direction
            ax.text(right, up, axis, fontsize=10, color=COLOURS[axis], ha="center", va="center")
    told = "seen along +z\nsolid: panda_hand, as the TCP\ndashed: panda_link8"
    ax.text(centre[0] + 0.052, centre[1] + 0.018, told, fontsize=9.5, ha="left", va="center")


def _arm(ax: Axes, hand: Hand) -> None:
    top = -hand.base
    corners = [(-0.032, top), (0.032, top), (0.026, top + 0.022), (-0.026, top + 0.022)]
    ax.add_patch(Polygon(corners, closed=True, facecolor="#b9c0c8", edgecolor="#4a5560", lw=1.2))
    ax.text(-0.031, top + 0.011, "arm", fontsize=10, ha="right", va="center", color="#4a5560")


def _width(ax: Axes, hand: Hand) -> None:
    half, below = hand.opening / 2, -hand.tip - 0.044
    for side in (-half, half):
        draw_level(ax, np.array([(side, -hand.tip), (side, below - 0.004)]))
    draw_dimension(ax, (-half, below), (half, below), "width", aside=(0, -0.012), ha="center")
