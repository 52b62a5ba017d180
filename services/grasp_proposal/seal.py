"""Kernel of suction: whether the lip of a round cup seals where it is set down."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

SECTORS = 12
"""Into how many equal pieces the lip is divided: each must lie on the surface."""
LIP = 0.25
"""Width of the band that counts as the lip, as a share of the cup's radius."""


class Seal(NamedTuple):
    """How S cups meet the surface.

    Attributes
    ----------
    covered : (S,) array
        How many of the `SECTORS` of the lip have surface under them.
    gap : (S,) array
        Difference in height along the lip between its highest and lowest sector, metres.
    bump : (S,) array
        How far the surface inside the lip stands out above the lip's highest sector, metres.
    in_focus : (S,) array
        Share of the points under the cup where a grasp is wanted.
    """

    covered: NDArray[np.int64]
    gap: Array
    bump: Array
    in_focus: Array


@kernel
def seal(
    points: Array, focus: Mask, centres: Array, rotations: Array, radius: float, depth: float
) -> Seal:
    """Set cups down and measure what lies under their lips.

    Parameters
    ----------
    points : (N, 3) array
    focus : (N,) bool array
    centres : (S, 3) array
        Middle of each lip.
    rotations : (S, 3, 3) array
        Columns x, y, z; z points into the surface.
    radius : float
        Of the lip, metres.
    depth : float
        A point further than this above or below the lip's middle is another surface.
    """
    number = len(centres)
    covered, in_focus = np.zeros(number, dtype=np.int64), np.zeros(number)
    gap, bump = np.zeros(number), np.zeros(number)
    total, count = np.empty(SECTORS), np.empty(SECTORS)
    inner, outer = (1.0 - LIP) * radius, (1.0 + LIP / 2) * radius
    for s in range(number):
        r = rotations[s]
        total[:], count[:] = 0.0, 0.0
        highest, under, wanted = -np.inf, 0.0, 0.0
        for n in range(len(points)):
            dx = points[n, 0] - centres[s, 0]
            dy = points[n, 1] - centres[s, 1]
            dz = points[n, 2] - centres[s, 2]
            height = -(r[0, 2] * dx + r[1, 2] * dy + r[2, 2] * dz)
            if abs(height) > depth:
                continue
            x = r[0, 0] * dx + r[1, 0] * dy + r[2, 0] * dz
            y = r[0, 1] * dx + r[1, 1] * dy + r[2, 1] * dz
            away = np.sqrt(x * x + y * y)
            if away > outer:
                continue
            under += 1.0
            wanted += focus[n]
            if away < inner:
                highest = max(highest, height)
                continue
            sector = int((np.arctan2(y, x) / (2 * np.pi) + 0.5) * SECTORS)
            sector = min(max(sector, 0), SECTORS - 1)
            total[sector] += height
            count[sector] += 1.0
        low, high = np.inf, -np.inf
        for k in range(SECTORS):
            if count[k] > 0:
                covered[s] += 1
                mean = total[k] / count[k]
                low, high = min(low, mean), max(high, mean)
        if covered[s] > 0:
            gap[s] = high - low
            bump[s] = max(highest - high, 0.0)
        in_focus[s] = wanted / max(under, 1.0)
    return Seal(covered, gap, bump, in_focus)
