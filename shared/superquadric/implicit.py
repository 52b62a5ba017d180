"""The inside-outside function and the radial distance (thesis Eq. 3.2 and 5.1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.superquadric.model import Superquadric

Array = NDArray[np.float64]

_TINY = 1e-12


def inside_outside(superquadric: Superquadric, points: Array) -> Array:
    """Return F (N,) at points (N, 3): below 1 inside, 1 on the surface, above 1 outside.

    Thesis Eq. 3.2. Small exponents raise to high powers; F may overflow to inf
    far outside, which still reads as outside.
    """
    e1, e2 = superquadric.exponents
    x, y, z = (np.abs(superquadric.to_local(points)) / superquadric.semi_axes).T
    with np.errstate(over="ignore"):
        flat = x ** (2 / e2) + y ** (2 / e2)
        return np.asarray(flat ** (e2 / e1) + z ** (2 / e1))


def radial_distance(superquadric: Superquadric, points: Array) -> Array:
    """Return signed distances (N,) to the surface along the ray from the centre, in metres.

    Negative inside. |p| (1 - F^(-e1/2)): the thesis prints the exponent of
    Eq. 5.1 as +e1/2, its code uses -e1/2, which is the radial distance proper
    (Gross and Boult 1988) and what this function computes. No value is below
    minus the smallest semi-axis: no interior point is deeper than that.
    """
    e1, e2 = superquadric.exponents
    local = superquadric.to_local(points)
    x, y, z = np.maximum(np.abs(local) / superquadric.semi_axes, _TINY).T
    # F^(e1/2) in logarithms, so that high powers neither overflow nor vanish.
    flat = (e2 / 2) * np.logaddexp((2 / e2) * np.log(x), (2 / e2) * np.log(y))
    scale = np.exp((e1 / 2) * np.logaddexp((2 / e1) * flat, (2 / e1) * np.log(z)))
    floor = min(superquadric.semi_axes)
    length = np.maximum(np.linalg.norm(local, axis=1), _TINY * floor)
    return np.asarray(np.maximum(length * (1 - 1 / scale), -floor))
