"""The box about each hand's closing region, and frames that a half turn does not change."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.hand import Hand

Array = NDArray[np.float64]

SIDE_SHARE, LEAST_SIDE = 0.75, 0.015
"""Half of the box along y: this share of the part's width, at least so many metres; the
pads are at +-2/3 then, whatever the width."""
FINGER_WIDTHS = 1.5
"""Half of the box along x."""
BEHIND_TIPS, BEYOND_TIPS = 0.045, 0.015
"""From where to where the box reaches along z, metres from the tips."""


class ClosingRegions(NamedTuple):
    """Boxes in G hands' frames.

    Attributes
    ----------
    centre : (G, 3) array
        Of the boxes, in the workspace.
    rotation : (G, 3, 3) array
        Columns x, y (closing), z (approach).
    half : (G, 3) array
        Half sides, metres.
    """

    centre: Array
    rotation: Array
    half: Array


def closing_regions(
    hand: Hand, tool_centre: Array, rotation: Array, width: Array
) -> ClosingRegions:
    """Return the boxes of hands with tool centre points (G, 3) on parts of these widths (G,)."""
    middle = hand.tip_beyond_tcp + (BEYOND_TIPS - BEHIND_TIPS) / 2
    half = np.empty((len(width), 3))
    half[:, 0] = FINGER_WIDTHS * hand.finger_width
    half[:, 1] = np.maximum(SIDE_SHARE * width, LEAST_SIDE)
    half[:, 2] = (BEHIND_TIPS + BEYOND_TIPS) / 2
    return ClosingRegions(tool_centre + middle * rotation[:, :, 2], rotation, half)


def upright(rotations: Array) -> Array:
    """Return rotations (G, 3, 3) turned by half a turn about z where y points to -y.

    A parallel gripper does not know its left finger from its right.
    """
    flip = (rotations[:, 1, 1] < 0) | ((rotations[:, 1, 1] == 0) & (rotations[:, 0, 1] < 0))
    sign = np.where(flip, -1.0, 1.0)[:, None]
    return np.stack(
        [rotations[:, :, 0] * sign, rotations[:, :, 1] * sign, rotations[:, :, 2]], axis=2
    )
