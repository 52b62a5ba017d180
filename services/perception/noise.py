"""How far measurements of a flat surface scatter, as a function of their range."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.perception.interpolation import interpolate
from services.perception.median import median

Array = NDArray[np.float64]

SIGMA_PER_MEDIAN = 1.4826
"""Standard deviation of a normal distribution over its median absolute value."""
_FLOOR_M = 1e-5


@dataclass(frozen=True)
class NoiseProfile:
    """Standard deviation of heights over a plane, piecewise linear in the range.

    Attributes
    ----------
    ranges : (B,) array
        Distances from the sensor, metres, increasing.
    sigmas : (B,) array
        Standard deviations at these ranges, metres, positive.
    """

    ranges: Array
    sigmas: Array

    def at(self, ranges: Array) -> Array:
        """Return the standard deviation at `ranges`, constant beyond the ends."""
        return interpolate(np.ascontiguousarray(ranges), self.ranges, self.sigmas)


def measure_noise(heights: Array, ranges: Array, bins: int = 8) -> NoiseProfile:
    """Return the profile of surface points with these heights and ranges, both (N,), N >= 1.

    Stereo depth scatters with the square of the depth, other sensors otherwise; so the
    surface itself is asked. In each of `bins` equally filled classes of range the median
    absolute height, which things on the surface hardly move, gives the deviation. It is
    taken about the plane, not about the class's own median, so that a warp counts too.
    """
    bins = min(bins, max(1, len(ranges) // 50))
    borders = np.arange(1, bins) * len(ranges) // bins
    order = np.argpartition(ranges, borders)
    away, ranges = np.abs(heights.take(order)), ranges.take(order)
    sigmas = [SIGMA_PER_MEDIAN * median(part) for part in np.split(away, borders)]
    middles = [median(part) for part in np.split(ranges, borders)]
    return NoiseProfile(np.array(middles), np.maximum(np.array(sigmas), _FLOOR_M))
