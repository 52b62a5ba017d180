"""How much background a primitive would cover that the sensor saw through to."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.parts.profile import SLICES
from shared.jit import kernel

Array = NDArray[np.float64]

_POWERS = (2.0, 4.0, 12.0)
"""Of superellipses from round to nearly square."""


def _shapes() -> Array:
    """Return relative widths (P, m, i) of slice i of a superellipse of m slices."""
    shapes = np.full((len(_POWERS), SLICES + 1, SLICES), np.inf)
    for p, power in enumerate(_POWERS):
        for m in range(1, SLICES + 1):
            x = np.abs((2 * np.arange(m) + 1 - m) / m)
            shapes[p, m, :m] = (1 - x**power) ** (1 / power)
    return shapes


_SHAPES = _shapes()
_AREAS = np.where(np.isfinite(_SHAPES), _SHAPES, 0.0).sum(axis=2)


class Coverage(NamedTuple):
    """Background that parts on either side of a cut cover, as shares of the object's area.

    Attributes
    ----------
    lower, upper : (SLICES + 1,) array
        By the slices before k, and from k on.
    whole : float
        By all of them.
    """

    lower: Array
    upper: Array
    whole: float


def coverage(width: Array) -> Coverage:
    """Return the covered background of the lower parts, the upper parts and the whole.

    The smallest superellipse about a part that spans its slices and holds all
    their widths covers more than the part itself; the excess is given as a
    share of the object's area.

    Parameters
    ----------
    width : (SLICES,) array
        Of the slices.
    """
    lower = excess(width, _SHAPES, _AREAS)
    upper = np.ascontiguousarray(excess(width[::-1].copy(), _SHAPES, _AREAS)[::-1])
    return Coverage(lower, upper, float(lower[-1]))


@kernel
def excess(width: Array, shapes: Array, areas: Array) -> Array:
    """Return the background (S + 1,) that the smallest superellipses about the first slices cover.

    Parameters
    ----------
    width : (S,) array
        Of the slices.
    shapes : (P, S + 1, S) array
        Relative widths of slice i of a superellipse of m slices, for each shape.
    areas : (P, S + 1) array
        Their sums.
    """
    covered = np.zeros(len(width) + 1)
    own = 0.0
    for m in range(1, len(width) + 1):
        own += width[m - 1]
        least = np.inf
        for p in range(len(shapes)):
            scale = 0.0
            for i in range(m):
                scale = max(scale, width[i] / shapes[p, m, i])
            least = min(least, scale * areas[p, m])
        covered[m] = least - own
    return covered / own
