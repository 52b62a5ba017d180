"""What a stereo depth camera makes of an ideal depth image."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StereoNoise:
    """Noise in disparity, hence growing with the square of the depth.

    With disparity d = f b / z, an error s in d is an error s z^2 / (f b) in z.

    Attributes
    ----------
    sigma_at_1m : float
        Standard deviation of the depth at 1 m, metres; sigma(z) = sigma_at_1m z^2.
    step_at_1m : float
        Step of the depth at 1 m, metres, that one step of the quantised
        disparity makes: 1/32 pixel of a camera with f = 615 and b = 50 mm.
    edge_jump : float
        Neighbours that differ by more than this share of the depth make an edge.
    edge_dropout : float
        Probability that a pixel at an edge gives no return.
    correlation_px : float
        Radius (sigma of a Gaussian) over which the errors of neighbours hang
        together, as a matching window makes them in real stereo; 0: every
        pixel has its own. The size of the errors stays the same.
    """

    sigma_at_1m: float = 1.5e-3
    step_at_1m: float = 1 / 32 / (615 * 0.050)
    edge_jump: float = 0.015
    edge_dropout: float = 0.5
    correlation_px: float = 0.0

    def scaled(self, factor: float) -> StereoNoise:
        """Return the same noise with errors `factor` times as large; steps and edges stay."""
        return replace(self, sigma_at_1m=factor * self.sigma_at_1m)

    def apply(self, depth: Array, rng: np.random.Generator) -> Array:
        """Return the noisy image (H, W) of an ideal one, metres; 0 is no return.

        The same generator state draws the same numbers for every pixel,
        whatever the image shows.
        """
        error = self.sigma_at_1m * self._correlated(rng.standard_normal(depth.shape))
        unlucky = rng.random(depth.shape) < self.edge_dropout
        seen = depth > 0
        inverse = np.divide(1.0, depth, out=np.zeros_like(depth), where=seen) + error
        inverse = self.step_at_1m * np.round(inverse / self.step_at_1m)
        keep = seen & ~(unlucky & self._edges(depth)) & (inverse > 0)
        return np.divide(1.0, inverse, out=np.zeros_like(depth), where=keep)

    def _correlated(self, white: Array) -> Array:
        """Return white noise (H, W) of unit variance, smoothed to the same variance.

        Images wrap around, so that the variance is the same up to the border.
        """
        smooth = white
        if self.correlation_px > 0:
            for axis, length in enumerate(white.shape):
                impulse = np.zeros(length)
                impulse[0] = 1.0
                gain = gaussian_filter1d(impulse, self.correlation_px, mode="wrap")
                smooth = gaussian_filter1d(smooth, self.correlation_px, axis=axis, mode="wrap")
                smooth = smooth / np.linalg.norm(gain)
        return smooth

    def _edges(self, depth: Array) -> NDArray[np.bool_]:
        """Return (H, W) where a pixel differs much from one of its four neighbours."""
        edges = np.zeros(depth.shape, dtype=bool)
        for axis in (0, 1):
            one, other = np.moveaxis(depth, axis, 0)[:-1], np.moveaxis(depth, axis, 0)[1:]
            jump = np.abs(one - other) > self.edge_jump * np.maximum(one, other)
            along = np.moveaxis(edges, axis, 0)
            along[:-1] |= jump
            along[1:] |= jump
        return edges
