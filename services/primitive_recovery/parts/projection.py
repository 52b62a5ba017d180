"""From points to their places in the sensor's picture, and back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.points import over_depth
from shared.geometry.rotation import frame_from_z
from shared.jit import kernel

Array = NDArray[np.float64]

STEEPEST = 4.0
"""Tangent of the widest angle off the mean ray that a point may have in the picture."""


@dataclass(frozen=True)
class Projection:
    """The plane across the mean viewing ray, central or, without a sensor, parallel.

    Attributes
    ----------
    frame : (3, 3) array
        Columns: the picture's two axes and the ray.
    eye : (3,) array or None
        Position of the sensor about the points' mean; None for a parallel projection.
    metres : float
        Per unit of length in the picture.
    """

    frame: Array
    eye: Array | None
    metres: float

    def placed(self, centred: Array) -> tuple[Array, Array]:
        """Return places (N, 2) and depths (N,) of points (N, 3) about the mean."""
        if self.eye is None:
            local = centred @ self.frame
            return np.ascontiguousarray(local[:, :2]), np.ascontiguousarray(local[:, 2])
        return over_depth((centred - self.eye) @ self.frame)

    def lifted(self, places: Array, depth: Array) -> Array:
        """Return the points (N, 3) about the mean at places (N, 2) and depths (N,)."""
        if self.eye is None:
            return np.column_stack([places, depth]) @ self.frame.T
        local = np.column_stack([places, np.ones(len(places))]) * depth[:, None]
        return np.asarray(local @ self.frame.T + self.eye)


def projected(
    centred: Array, eye: Array | None, ray: Array, along: Array
) -> tuple[Projection, Array, Array]:
    """Return the projection of an object, and places (N, 2) and depths (N,) of its points.

    Parameters
    ----------
    centred : (N, 3) array
        Points about their mean, metres.
    eye : (3,) array or None
        Position of the sensor about that mean. Without it, or where it is so
        close that no picture spans them all, the points are projected in parallel.
    ray : (3,) array
        Unit vector from the sensor to the mean.
    along : (3,) array
        Direction that becomes the first axis, so that the picture turns with
        the object.
    """
    x_axis, y_axis = across(ray, along)
    frame = np.column_stack([x_axis, y_axis, ray])
    if eye is not None:
        local = (centred - eye) @ frame
        if within_cone(local, STEEPEST):
            places, depth = over_depth(local)
            return Projection(frame, eye, float(depth.mean())), places, depth
    parallel = Projection(frame, None, 1.0)
    return parallel, *parallel.placed(centred)


@kernel
def within_cone(local: Array, tangent: float) -> bool:
    """Return whether no ray to points (N, 3) is so far off the third axis, by its tangent."""
    for n in range(local.shape[0]):
        aside = np.sqrt(local[n, 0] * local[n, 0] + local[n, 1] * local[n, 1])
        if aside >= tangent * local[n, 2]:
            return False
    return True


def across(axis: Array, towards: Array) -> tuple[Array, Array]:
    """Return two unit vectors (3,) across a unit vector: the one nearest `towards`, and the other.

    Where both are parallel, any two.
    """
    one = towards - (towards @ axis) * axis
    length = float(np.sqrt(one @ one))
    if length < 1e-6:
        frame = frame_from_z(axis)
        return frame[:, 0], frame[:, 1]
    one = one / length
    (a, b, c), (x, y, z) = axis, one
    return one, np.array([b * z - c * y, c * x - a * z, a * y - b * x])
