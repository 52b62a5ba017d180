"""The superquadric of the thesis' Eq. 3.3 as a frozen value object."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from shared.geometry.rotation import matrix_from_quaternion
from shared.geometry.se3 import pose_matrix

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Superquadric:
    """A superquadric in some frame.

    Attributes
    ----------
    exponents : tuple of float
        (e1, e2): e1 shapes the profile along its z, e2 the cross-section in its x-y.
    semi_axes : tuple of float
        (a1, a2, a3) in metres along its own x, y, z.
    position : tuple of float
        Its centre in metres.
    quaternion : tuple of float
        [x, y, z, w], rotation from its own frame.
    """

    exponents: tuple[float, float]
    semi_axes: tuple[float, float, float]
    position: tuple[float, float, float]
    quaternion: tuple[float, float, float, float]

    @classmethod
    def from_vector(cls, parameters: Sequence[float] | Array) -> Superquadric:
        """Read `[e1, e2, a1, a2, a3, tx, ty, tz, qx, qy, qz, qw]`."""
        e1, e2, a1, a2, a3, tx, ty, tz, qx, qy, qz, qw = map(float, parameters)
        return cls((e1, e2), (a1, a2, a3), (tx, ty, tz), (qx, qy, qz, qw))

    def to_vector(self) -> Array:
        """Return the 12 parameters (12,) in the order of Eq. 3.3."""
        return np.array([*self.exponents, *self.semi_axes, *self.position, *self.quaternion])

    @cached_property
    def rotation(self) -> Array:
        """Rotation matrix (3, 3) from its own frame."""
        return matrix_from_quaternion(self.quaternion)

    @property
    def pose(self) -> Array:
        """Motion (4, 4) from its own frame."""
        return pose_matrix(self.position, self.rotation)

    @property
    def full_extents(self) -> tuple[float, float, float]:
        """Edge lengths 2a of its bounding box in metres, along its own axes."""
        a1, a2, a3 = self.semi_axes
        return (2 * a1, 2 * a2, 2 * a3)

    def to_local(self, points: Array) -> Array:
        """Return points (N, 3) in the superquadric's own frame."""
        return np.asarray((points - np.asarray(self.position)) @ self.rotation)

    def to_outer(self, points: Array) -> Array:
        """Return points (N, 3) of its own frame in the frame it is given in."""
        return np.asarray(points @ self.rotation.T + np.asarray(self.position))
