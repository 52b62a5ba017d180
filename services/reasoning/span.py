"""How far a superquadric reaches in a direction."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.superquadric import Superquadric

Array = NDArray[np.float64]


def support(shape: Superquadric, directions: Array) -> Array:
    """Return how far a shape reaches from its centre along directions (3, K): (K,) metres.

    The support function of a superellipsoid is the dual norm of its implicit
    function: with exponent e, the p-norm of p = 2 / (2 - e).
    """
    scaled = np.abs(shape.rotation.T @ directions) * np.array(shape.semi_axes)[:, None]
    e1, e2 = shape.exponents
    flat = _norm(scaled[0], scaled[1], e2)
    return _norm(flat, scaled[2], e1)


def _norm(one: Array, other: Array, exponent: float) -> Array:
    if exponent >= 1.99:  # an octahedron's dual is a cube
        return np.maximum(one, other)
    p = 2.0 / (2.0 - exponent)
    largest = np.maximum(np.maximum(one, other), 1e-12)
    return np.asarray(largest * ((one / largest) ** p + (other / largest) ** p) ** (1 / p))
