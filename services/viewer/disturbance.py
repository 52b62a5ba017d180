"""A worse view of the same scene: noisier, or with something before the object."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from services.viewer.sources import Seen
from shared.geometry.rotation import frame_from_z, unit

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

MARGIN = 0.15
"""By how much what hides the object is larger than it, in parts of the object."""


@dataclass(frozen=True)
class Disturbance:
    """What is done to a view.

    Attributes
    ----------
    noise_mm : float
        Standard deviation of the depth at a distance of 1 m; it grows with the square of the
        distance, as a stereo camera's does.
    hidden : float
        Share of the object, from its left, that something stands before; 0 to 1.
    seed : int
        The same one gives the same noise.
    """

    noise_mm: float = 0.0
    hidden: float = 0.0
    seed: int = 0

    def of(self, seen: Seen, on_object: Mask, up: ArrayLike) -> Seen:
        """Return the disturbed view.

        Parameters
        ----------
        seen : Seen
        on_object : (N,) array of bool
            Which points are the object's, as far as is known.
        up : (3,) array_like
            Against gravity.
        """
        gaze = seen.points - seen.viewpoint
        gone = _behind(gaze, on_object, up, self.hidden) if self.hidden > 0 else None
        stretch = self._stretch(np.linalg.norm(gaze, axis=1)) if self.noise_mm > 0 else None
        if gone is None and stretch is None:
            return seen
        return _moved(seen, gaze, stretch, gone)

    def _stretch(self, distance: Array) -> Array:
        """Return by what factor every point is nearer or farther."""
        rng = np.random.default_rng(self.seed)
        sigma = 1e-3 * self.noise_mm * np.square(distance)
        with np.errstate(divide="ignore", invalid="ignore"):
            stretch = 1 + rng.normal(size=len(distance)) * sigma / distance
        return np.where(distance > 0, np.maximum(stretch, 0.05), 1.0)


def _behind(gaze: Array, on_object: Mask, up: ArrayLike, share: float) -> Mask | None:
    """Return which points (N,) a screen before the object's left part hides."""
    if not on_object.any():
        return None
    forward = unit(gaze[on_object].mean(axis=0))
    frame = frame_from_z(forward, x_hint=np.cross(unit(up), forward))
    local = gaze @ frame
    with np.errstate(divide="ignore", invalid="ignore"):
        across = local[:, :2] / local[:, 2:]
    low, high = across[on_object].min(axis=0), across[on_object].max(axis=0)
    edge = np.quantile(across[on_object, 0], 1 - share)  # +x is to the left: up x forward
    margin = MARGIN * (high - low)
    inside = (across >= low - margin).all(axis=1) & (across <= high + margin).all(axis=1)
    hidden: Mask = inside & (across[:, 0] >= edge) & (local[:, 2] > 0)
    return hidden


def _moved(seen: Seen, gaze: Array, stretch: Array | None, gone: Mask | None) -> Seen:
    view = seen.view
    if view.depth is not None:
        depth = view.depth.astype(np.float64)
        if stretch is not None:
            depth *= stretch.reshape(depth.shape)
        if gone is not None:
            depth[gone.reshape(depth.shape)] = 0
        if view.depth.dtype.kind in "iu":
            depth = np.clip(np.rint(depth), 0, np.iinfo(view.depth.dtype).max)
        return Seen.of(view.model_copy(update={"depth": depth.astype(view.depth.dtype)}))
    points = seen.points.copy()
    if stretch is not None:
        points = seen.viewpoint + gaze * stretch[:, None]
    if gone is not None:
        points[gone] = np.nan
    return Seen.of(view.model_copy(update={"points": points}))
