"""The pinhole model: x right, y down, z ahead (the optical frame)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shared.geometry.rotation import unit
from shared.geometry.se3 import pose_matrix

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PinholeCamera:
    """A camera without distortion; lengths in pixels."""

    width: int
    height: int
    focal_length: float

    @property
    def intrinsics(self) -> Array:
        """Pinhole matrix (3, 3); the principal point is the image's centre."""
        f = self.focal_length
        return np.array([[f, 0, self.width / 2], [0, f, self.height / 2], [0, 0, 1.0]])

    def rays(self) -> Array:
        """Return one direction per pixel (H, W, 3) in the camera's frame, with z = 1."""
        k = self.intrinsics
        x = (np.arange(self.width) - k[0, 2]) / k[0, 0]
        y = (np.arange(self.height) - k[1, 2]) / k[1, 1]
        grid = np.stack(np.meshgrid(x, y), axis=-1)
        return np.concatenate([grid, np.ones((self.height, self.width, 1))], axis=-1)


D435 = PinholeCamera(640, 480, 615.0)
"""About the depth stream of an Intel RealSense D435 at 640 x 480."""


def look_at(position: ArrayLike, target: ArrayLike) -> Array:
    """Return world_from_camera (4, 4) of a camera at `position`, upright, facing `target`.

    The world's z is up; the two points must not lie above one another.
    """
    eye = np.asarray(position, dtype=np.float64)
    ahead = unit(np.asarray(target, dtype=np.float64) - eye)
    right = unit(np.cross(ahead, [0.0, 0.0, 1.0]))
    return pose_matrix(eye, np.column_stack([right, np.cross(ahead, right), ahead]))
