"""The gauge of a superquadric in logarithms: one formula for the surface and for its supports."""

from __future__ import annotations

import math

from shared.jit import kernel

TINY = 1e-12


@kernel
def log_gauge(
    x: float, y: float, z: float, e1: float, e2: float
) -> tuple[float, float, float, float, float, float]:
    """Return L = log of the nested norm of three log-coordinates, and its derivatives.

    L = log (((X^(2/e2) + Y^(2/e2))^(e2/e1) + Z^(2/e1))^(e1/2)) for x = log X and so on:
    a point at X, Y, Z (in semi-axes) lies exp(L) times as far out as the surface. The
    support function of a superquadric is the same formula of the direction's components
    times the semi-axes, with 2 - e for each exponent e (dual norms).

    Returns
    -------
    value, to_x, to_y, to_z, to_e1, to_e2 : float
        L and its partial derivatives; to_x + to_y + to_z = 1.
    """
    gap = 2.0 / e2 * abs(x - y)
    small = math.exp(-gap)
    swell = math.log1p(small)
    minor = small / (1.0 + small)
    entropy2 = swell + gap * minor
    flat = max(x, y) + 0.5 * e2 * swell
    share_x = 1.0 - minor if x >= y else minor
    gap = 2.0 / e1 * abs(flat - z)
    small = math.exp(-gap)
    swell = math.log1p(small)
    minor = small / (1.0 + small)
    entropy1 = swell + gap * minor
    share = 1.0 - minor if flat >= z else minor
    value = max(flat, z) + 0.5 * e1 * swell
    return (
        value,
        share * share_x,
        share * (1.0 - share_x),
        1.0 - share,
        0.5 * entropy1,
        0.5 * share * entropy2,
    )
