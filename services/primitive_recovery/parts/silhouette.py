"""What the sensor saw of an object as a picture: the cells of its silhouette."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.parts.grid import grown
from shared.geometry.rotation import frame_from_z

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Indices = NDArray[np.intp]

LONGEST = 128
"""Cells along the longer side at most: more detail than any border between parts needs."""

CELL = 1.5
"""Side of a cell in spacings of the points. A square with more than sqrt(2) holds a
point of every square lattice however it is turned, so a camera's pixels leave no gaps."""

BORDER = 2
"""Empty cells around the silhouette."""

STEEPEST = 4.0
"""Tangent of the widest angle off the mean ray that a point may have in the picture."""


@dataclass(frozen=True)
class Silhouette:
    """A picture of the object on the plane across the mean viewing ray.

    Attributes
    ----------
    mask : (H, W) bool array
        Cells where the object was seen.
    row, column : (N,) array
        Cell of each point.
    cell : float
        Side of a cell, metres at the points' mean distance.
    """

    mask: Mask
    row: Indices
    column: Indices
    cell: float

    @property
    def closed(self) -> Mask:
        """Cells (H, W) of the silhouette with its narrowest gaps filled."""
        return np.asarray(self.mask | ~grown(~grown(self.mask, 1), 1))

    def at_points(self, picture: NDArray[np.generic]) -> NDArray[np.generic]:
        """Return the value of a picture (H, W) at each point (N,)."""
        return picture[self.row, self.column]


def silhouette(flat: Array, apart: float, metres: float) -> Silhouette:
    """Return the silhouette of points projected to a plane.

    Parameters
    ----------
    flat : (N, 2) array
        See `project`.
    apart : float
        About how far neighbours are apart there.
    metres : float
        Per unit of length there.
    """
    low = flat.min(axis=0)
    spread = float(max(np.ptp(flat, axis=0).max(), 1e-12))
    side = max(CELL * apart, spread / (LONGEST - 1))
    cells = np.floor((flat - low) / side).astype(np.intp) + BORDER
    rows, columns = cells.max(axis=0) + 1 + BORDER
    mask = np.zeros((rows, columns), dtype=bool)
    mask[cells[:, 0], cells[:, 1]] = True
    return Silhouette(mask, cells[:, 0], cells[:, 1], side * metres)


def project(
    centred: Array, viewpoint: Array | None, ray: Array, along: Array
) -> tuple[Array, float]:
    """Return each point's place (N, 2) on the plane across a ray, and metres per unit there.

    Parameters
    ----------
    centred : (N, 3) array
        Points about their mean, metres.
    viewpoint : (3,) array or None
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
    if viewpoint is None:
        return centred @ frame[:, :2], 1.0
    placed = (centred - viewpoint) @ frame
    depth = placed[:, 2]
    aside = np.sqrt(placed[:, 0] ** 2 + placed[:, 1] ** 2)
    if (aside >= STEEPEST * depth).any():
        return centred @ frame[:, :2], 1.0
    return placed[:, :2] / depth[:, None], float(depth.mean())


def spacing(flat: Array) -> float:
    """Return about how far neighbours are apart, of points (N, 2) spread over an area."""
    extent = np.maximum(np.ptp(flat, axis=0), 1e-12)
    coarse = float(np.sqrt(extent.prod() / len(flat)))
    coarse = max(coarse, float(extent.max()) / 512)
    cells = np.floor((flat - flat.min(axis=0)) / coarse).astype(np.intp)
    rows, columns = cells.max(axis=0) + 1
    occupied = np.zeros(rows * columns, dtype=bool)
    occupied[cells[:, 0] * columns + cells[:, 1]] = True
    return coarse * float(np.sqrt(np.count_nonzero(occupied) / len(flat)))


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
