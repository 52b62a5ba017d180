"""The E step: how likely each point belongs to the superquadric."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

OUTLIER_PROBABILITY = 0.1
"""A point that is less likely an inlier than this is an outlier (thesis, Algorithm 1)."""


def inlier_probability(
    distances: Array, variance: float, outlier_ratio: float, volume: float
) -> Array:
    """Return posterior probabilities (N,) of being an inlier.

    Liu et al. 2022, E step: inliers spread about the surface with an isotropic
    Gaussian, outliers evenly over the volume that the points fill.

    Parameters
    ----------
    distances : (N,) array
    variance : float
        sigma^2 of the Gaussian, positive.
    outlier_ratio : float
        Prior probability of an outlier, in [0, 1).
    volume : float
        Of the points' bounding box, positive.
    """
    clutter = outlier_ratio / (1 - outlier_ratio) / volume * math.sqrt(2 * math.pi * variance) ** 3
    likelihood = np.exp(np.maximum(distances**2 / (-2 * variance), -700.0))
    return np.asarray(likelihood / (likelihood + clutter))
