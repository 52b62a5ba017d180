"""The superquadric while it is being fitted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.ems.kernels import normal_equations, radial_distances, turned

Array = NDArray[np.float64]


@dataclass(frozen=True)
class State:
    """A superquadric as three arrays, in the fit's frame and unit.

    Attributes
    ----------
    shape : (5,) array
        [e1, e2, a1, a2, a3]
    rotation : (3, 3) array
        From its own frame.
    position : (3,) array
    """

    shape: Array
    rotation: Array
    position: Array

    def distances(self, points: Array) -> Array:
        """Return signed radial distances (N,) of points (N, 3)."""
        return radial_distances(points, self.shape, self.rotation, self.position)

    def normal_equations(self, points: Array, weights: Array) -> tuple[float, Array, Array]:
        """Return cost, gradient (11,) and Gauss-Newton matrix (11, 11); see the kernel."""
        return normal_equations(points, weights, self.shape, self.rotation, self.position)

    def moved(self, step: Array, lower: Array, upper: Array) -> State:
        """Return the state after a step (11,), shape and position clipped to bounds (8,)."""
        values = np.concatenate([self.shape + step[:5], self.position + step[8:]])
        values = np.minimum(np.maximum(values, lower), upper)
        return State(values[:5], turned(self.rotation, step[5:8]), values[5:])
