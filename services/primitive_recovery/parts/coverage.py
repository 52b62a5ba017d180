"""How much background a primitive would cover that the sensor saw through to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.parts.profile import SLICES

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


def coverage(width: Array) -> tuple[Array, Array, float]:
    """Return the covered background of the lower parts, the upper parts and the whole.

    The smallest superellipse about a part that spans its slices and holds all
    their widths covers more than the part itself; the excess is given as a
    share of the object's area.

    Parameters
    ----------
    width : (SLICES,) array
        Of the slices.

    Returns
    -------
    lower, upper : (SLICES + 1,) array
        Of the slices before k, and from k on.
    whole : float
        Of all of them.
    """
    lower = _excess(width)
    upper = _excess(width[::-1])[::-1]
    return lower, upper, float(lower[-1])


def _excess(width: Array) -> Array:
    scale = (width / _SHAPES).max(axis=2)
    area = (scale * _AREAS).min(axis=0)
    own = np.concatenate([[0.0], np.cumsum(width)])
    return np.asarray((area - own) / own[-1])
