"""How large a superquadric may become while it is fitted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.ems.start import LARGEST_COORDINATE, THINNEST
from services.primitive_recovery.ems.state import State

Array = NDArray[np.float64]

LEAST_EXPONENT, MOST_EXPONENT = 0.1, 2.0
LEAST_SEMI_AXIS = 0.01
"""In units of the fit: a thousandth of the cloud's largest coordinate."""

_SLACK = 1.1


@dataclass(frozen=True)
class Bounds:
    """Limits (8,) of [e1, e2, a1, a2, a3, tx, ty, tz]."""

    lower: Array
    upper: Array

    @classmethod
    def of(cls, semi_axes: Array, position: Array) -> Bounds:
        """Return the bounds for the largest semi-axes (3,) and |position| (3,)."""
        largest = np.maximum(semi_axes, 2 * LEAST_SEMI_AXIS)
        return cls(
            np.array([LEAST_EXPONENT] * 2 + [LEAST_SEMI_AXIS] * 3 + list(-position)),
            np.array([MOST_EXPONENT] * 2 + list(largest) + list(position)),
        )


def current_bounds(points: Array, state: State, *, adaptive: bool) -> Bounds:
    """Return the bounds of the next M step on points (N, 3) in the fit's frame.

    Liu et al. allow four times the largest coordinate in every direction, which
    lets a surface seen from one side swell far behind it. Here at most as much
    again is hidden as is seen: a semi-axis may be 1.1 times the points' range along
    it. Adaptive (Liu et al.): 1.1 times their reach from the current centre, and
    the centre within 1.1 times their reach from their mean. A tenth of the cloud's
    width is allowed in any case, or a sheet could not become a slab.
    """
    length = np.full(3, _SLACK * LARGEST_COORDINATE)
    reach = _SLACK * np.abs(points).max(axis=0)
    thinnest = THINNEST * float(np.sort(reach)[1])
    local = np.einsum("ni,ij->nj", points - state.position, state.rotation)
    semi_axes = np.minimum(_SLACK * np.ptp(local, axis=0), length)
    position = length
    if adaptive:
        semi_axes = np.minimum(semi_axes, _SLACK * np.abs(local).max(axis=0))
        position = np.maximum(reach, thinnest)
    return Bounds.of(np.maximum(semi_axes, thinnest), position)
