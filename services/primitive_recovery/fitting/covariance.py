"""How sure a fit is of its parameters."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

INFLATION = 2.0
"""Standard deviations from the Jacobian, times this: supports and points are off together."""
LEAST = 0.05
"""Of a semi-axis, as a share of it: what is left when nothing is unseen."""

_ORDER = [0, 1, 2, 3, 4, 8, 9, 10, 5, 6, 7]
_REORDERED = np.ix_(_ORDER, _ORDER)


def covariance_of(matrix: Array, axes: Array, scale: float, signs: Array) -> Array:
    """Return the covariance (11, 11) in the order and the units of `PartFit`.

    The inverse of the Gauss-Newton matrix of all terms, priors included, scaled and
    floored so that two standard deviations hold what they promise on the catalogue
    (docs/decisions/0015-fitting.md).

    Parameters
    ----------
    matrix : (11, 11) array
        Of [e1, e2, log a, omega, t], in the unit of the fit.
    axes : (3,) array
        Semi-axes in metres.
    scale : float
        Metres per unit of the fit.
    signs : (3,) array
        By which the frame's axes were flipped afterwards.
    """
    units = np.array([1.0, 1.0, *axes, *signs, scale, scale, scale])
    # All terms are in unit variance; the ridge only keeps what nothing constrains finite.
    inverse = np.linalg.inv(matrix + 1e-9 * np.trace(matrix) / 11 * np.eye(11))
    covariance = INFLATION**2 * inverse * np.outer(units, units)
    covariance[2:5, 2:5] += np.diag((LEAST * axes) ** 2)
    covariance = covariance[_REORDERED]
    return np.asarray((covariance + covariance.T) / 2)
