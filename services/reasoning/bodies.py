"""Several superquadrics at once: how far they reach, and the boxes around them.

An object has few parts, and what is asked about them (`layout.py`) is a few numbers for each
pair: one call of NumPy for all of them takes no longer than one for each of them does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shared.geometry.rotation import matrix_from_quaternion
from shared.superquadric import Superquadric

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Bodies:
    """P superquadrics in one frame.

    Attributes
    ----------
    exponents : (P, 2) array
    semi_axes, positions : (P, 3) array
        Metres.
    rotations : (P, 3, 3) array
        From their own frames.
    """

    exponents: Array
    semi_axes: Array
    positions: Array
    rotations: Array

    @classmethod
    def of(cls, shapes: Sequence[Superquadric]) -> Bodies:
        """Return these superquadrics, one or more."""
        rows = np.array([shape.to_vector() for shape in shapes])
        return cls(rows[:, :2], rows[:, 2:5], rows[:, 5:8], matrix_from_quaternion(rows[:, 8:]))

    @property
    def full_extents(self) -> Array:
        """Edge lengths (P, 3) of the box around each along its own axes."""
        return 2 * self.semi_axes

    def reach(self, directions: Array) -> Array:
        """Return how far each reaches from its centre along directions: (P, K) metres.

        The support function of a superellipsoid is the dual norm of its implicit function:
        with exponent e, the p-norm of p = 2 / (2 - e).

        Parameters
        ----------
        directions : (K, 3) or (P, K, 3) array
            Unit vectors; the same for all, or of its own for each.
        """
        local = np.abs(directions @ self.rotations) * self.semi_axes[:, None]
        flat = _norm(local[..., 0], local[..., 1], self.exponents[:, 1:])
        return _norm(flat, local[..., 2], self.exponents[:, :1])

    def boxes(self, frames: Array) -> tuple[Array, Array]:
        """Return lowest and highest corners (P, F, 3) of the box around each along axes.

        Parameters
        ----------
        frames : (F, 3, 3) array
            The columns of each are the axes.
        """
        axes = frames.transpose(0, 2, 1).reshape(-1, 3)
        middle, half = self.positions @ axes.T, self.reach(axes)
        shape = (len(middle), len(frames), 3)
        return (middle - half).reshape(shape), (middle + half).reshape(shape)


def _norm(one: Array, other: Array, exponents: Array) -> Array:
    """Return the dual norms (P, K) of two coordinates (P, K) by exponents (P, 1)."""
    p = 2.0 / np.maximum(2.0 - exponents, 0.01)  # an octahedron's dual is a cube
    largest = np.maximum(np.maximum(one, other), 1e-12)
    return np.asarray(largest * ((one / largest) ** p + (other / largest) ** p) ** (1 / p))
