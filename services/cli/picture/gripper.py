"""The drawn gripper: a fork with its approach."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from services.cli.picture.view import View
from shared.geometry.rotation import matrix_from_quaternion

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

FINGER, TIP, WRIST, ARROW = 0.045, 0.008, 0.030, 0.045
"""Lengths in metres: palm to grasp centre, tips beyond it, wrist, approach."""
PIECE, COVER = 0.002, 0.003
"""Lengths in metres: of a piece that is hidden as a whole, and around a point that hides."""


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
    axes: Axes, view: View, hand: Hand, cloud: Array, colour: str, *, width: float, opacity: float
) -> None:
    """Draw a gripper; what the cloud (N, 3) hides of it is dotted.

    The one drawn fully opaque also gets an outline and its approach.
    """
    outline = [withStroke(linewidth=2 * width, foreground="white")] if opacity == 1 else []
    for line in (hand.fork, hand.wrist):
        pieces = _pieces(line)
        hidden = is_hidden(pieces.mean(axis=1), view, cloud)
        for which, style in ((~hidden, "solid"), (hidden, "dotted")):
            for run in _runs(pieces, which):
                axes.plot(
                    *view.flat(run).T,
                    color=colour,
                    alpha=opacity if style == "solid" else 0.55 * opacity,
                    linewidth=width if style == "solid" else 0.6 * width,
                    linestyle=style,
                    solid_capstyle="round",
                    solid_joinstyle="round",
                    path_effects=outline if style == "solid" else [],
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


def is_hidden(points: Array, view: View, cloud: Array) -> Mask:
    """Return which points (K, 3) the cloud (N, 3) stands in front of, as the eye sees it."""
    if not len(cloud):
        return np.zeros(len(points), dtype=np.bool_)
    of_cloud, of_points = cKDTree(view.flat(cloud)), cKDTree(view.flat(points))
    near: list[list[int]] = of_points.query_ball_tree(of_cloud, COVER)
    front, own = view.nearness(cloud), view.nearness(points)
    return np.array(
        [
            bool(around) and float(front[around].max()) > depth + COVER
            for around, depth in zip(near, own, strict=True)
        ]
    )


def _pieces(line: Array) -> Array:
    """Return a line (K, 3) as short straight pieces (S, 2, 3)."""
    pieces = []
    for start, end in itertools.pairwise(line):
        count = max(int(np.linalg.norm(end - start) / PIECE), 1)
        ends = start + np.linspace(0, 1, count + 1)[:, None] * (end - start)
        pieces.append(np.stack([ends[:-1], ends[1:]], axis=1))
    return np.concatenate(pieces)


def _runs(pieces: Array, chosen: Mask) -> list[Array]:
    """Return the chosen pieces (S, 2, 3) as lines (K, 3), those that follow each other as one."""
    rows = np.flatnonzero(chosen)
    groups = np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1) if len(rows) else []
    return [np.concatenate([pieces[group, 0], pieces[group[-1], 1:]]) for group in groups]
