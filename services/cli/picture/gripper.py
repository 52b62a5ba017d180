"""The drawn gripper: a fork with its approach."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from services.cli.picture.view import View
from shared.geometry.rotation import matrix_from_quaternion

Array = NDArray[np.float64]

FINGER, TIP, WRIST, ARROW = 0.045, 0.008, 0.030, 0.045
"""Lengths in metres: palm to grasp centre, tips beyond it, wrist, approach."""


@dataclass(frozen=True)
class Hand:
    """Lines of a gripper in the points' frame, metres: tip-palm-palm-tip, wrist, approach."""

    fork: Array
    wrist: Array
    approach: Array

    @property
    def corners(self) -> Array:
        """All its points (8, 3)."""
        return np.concatenate([self.fork, self.wrist, self.approach])

    @classmethod
    def of(cls, grasp: Array) -> Hand:
        """Return the gripper of a row x y z qx qy qz qw width score."""
        rotation, half = matrix_from_quaternion(grasp[3:7]), grasp[7] / 2

        def placed(*corners: tuple[float, float]) -> Array:
            return np.array([[0.0, y, z] for y, z in corners]) @ rotation.T + grasp[:3]

        palm, wrist = -FINGER, -FINGER - WRIST
        return cls(
            fork=placed((-half, TIP), (-half, palm), (half, palm), (half, TIP)),
            wrist=placed((0, palm), (0, wrist)),
            approach=placed((0, wrist - 0.008 - ARROW), (0, wrist - 0.008)),
        )


def draw_hand(
    axes: Axes, view: View, hand: Hand, colour: str, *, width: float, opacity: float
) -> None:
    """Draw a gripper; the one drawn fully opaque also gets an outline and its approach."""
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
