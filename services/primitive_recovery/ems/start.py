"""Where a fit starts: the cloud's own frame and unit, and the first guess."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.ems.state import State
from shared.geometry.rotation import quaternion_from_matrix
from shared.superquadric import Superquadric

Array = NDArray[np.float64]

LARGEST_COORDINATE = 10.0
"""Of the rescaled cloud (Liu et al.); tolerances and start variance refer to it."""
SHEET = 0.1
"""A cloud whose standard deviation across is a smaller share of its width is a sheet."""
THINNEST = 0.1
"""Thickness, as a share of the cloud's width, that no bound goes below."""


@dataclass(frozen=True)
class FitFrame:
    """Principal axes about the mean, rescaled: what makes a fit follow rigid motions.

    Attributes
    ----------
    centre : (3,) array
        Mean of the points, in metres.
    axes : (3, 3) array
        Right-handed columns: of the smallest, the middle and the largest variance.
    unit : float
        Metres per unit of the fit.
    """

    centre: Array
    axes: Array
    unit: float

    @classmethod
    def of(cls, points: Array) -> FitFrame:
        """Return the frame of points (N, 3) that are not all the same."""
        centre = points.mean(axis=0)
        centred = points - centre
        size = float(np.abs(centred).max())
        centred = centred / size
        covariance = np.einsum("ni,nj->ij", centred, centred)
        axes = np.linalg.eigh(covariance)[1]
        # An axis points to where the points reach further, so that the frame moves
        # with the points instead of flipping.
        local = np.einsum("ni,ij->nj", centred, axes)
        axes = axes * np.where((local**3).sum(axis=0) < 0, -1.0, 1.0)
        if np.linalg.det(axes) < 0:
            axes[:, 0] *= -1
        largest = float(np.abs(local).max())
        return cls(centre, axes, size * largest / LARGEST_COORDINATE)

    def to_fit(self, points: Array) -> Array:
        """Return points (N, 3) in the fit's frame and unit."""
        return np.asarray(np.einsum("ni,ij->nj", (points - self.centre) / self.unit, self.axes))

    def to_metres(self, state: State) -> Superquadric:
        """Return a fitted state in the frame of the points, in metres."""
        e1, e2 = state.shape[:2]
        position = self.centre + self.unit * (self.axes @ state.position)
        return Superquadric.from_vector(
            [
                e1,
                e2,
                *(self.unit * state.shape[2:]),
                *position,
                *quaternion_from_matrix(self.axes @ state.rotation),
            ]
        )


def first_guess(points: Array, away: Array) -> State:
    """Return where the fit of points (N, 3) in the fit's frame starts.

    Liu et al.: the ellipsoid along the cloud's axes about its mean, its semi-axes
    the median coordinates; x, y, z are its longest, thinnest and middle axis.

    A sheet defeats that: from a centre inside it, the radial distance of its points
    is the way to its rim. One face of a flat object is such a sheet, so the fit of
    one starts from a slab whose face it is, on the side `away` (3,) from the sensor.
    """
    thickness, width, _ = points.std(axis=0)
    if thickness < SHEET * width:
        return _slab_behind(points, away)
    order = [2, 0, 1]
    semi_axes = np.maximum(np.median(np.abs(points), axis=0), 0.05)[order]
    return State(np.concatenate([[1.0, 1.0], semi_axes]), _permutation(order), np.zeros(3))


def _slab_behind(points: Array, away: Array) -> State:
    order = [1, 2, 0]
    semi_axes = np.percentile(np.abs(points), 95, axis=0)[order]
    semi_axes[2] = max(semi_axes[2], THINNEST * semi_axes[0])
    behind = semi_axes[2] if away[0] >= 0 else -semi_axes[2]
    shape = np.concatenate([[0.2, 0.5], semi_axes])
    return State(shape, _permutation(order), np.array([behind, 0.0, 0.0]))


def _permutation(order: list[int]) -> Array:
    return np.ascontiguousarray(np.eye(3)[:, order])
