"""What the sensor saw of an object as a picture: the cells of its silhouette."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.parts.grid import grown
from shared.geometry.passes import corners
from shared.jit import kernel

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
    low : (2,) array
        Where the first cell begins, in the plane's own unit.
    side : float
        Side of a cell in that unit.
    """

    mask: Mask
    row: Indices
    column: Indices
    cell: float
    low: Array
    side: float

    @cached_property
    def closed(self) -> Mask:
        """Cells (H, W) of the silhouette with its narrowest gaps filled."""
        return np.asarray(self.mask | ~grown(~grown(self.mask, 1), 1))

    def cells_of(self, places: Array) -> Indices:
        """Return the rows and columns (N, 2) of places (N, 2) on the plane, also outside."""
        return np.floor((places - self.low) / self.side).astype(np.intp)

    def middles(self, cells: Indices) -> Array:
        """Return where on the plane the middles (N, 2) of cells (N, 2) are."""
        return np.asarray(self.low + (cells + 0.5) * self.side)

    def at_points(self, picture: NDArray[np.generic]) -> NDArray[np.generic]:
        """Return the value of a picture (H, W) at each point (N,)."""
        return picture[self.row, self.column]


def silhouette(flat: Array, apart: float, metres: float) -> Silhouette:
    """Return the silhouette of points projected to a plane.

    Parameters
    ----------
    flat : (N, 2) array
        On the plane across the mean viewing ray.
    apart : float
        About how far neighbours are apart there.
    metres : float
        Per unit of length there.
    """
    low, high = corners(flat)
    extent = high - low
    side = max(CELL * apart, float(max(extent.max(), 1e-12)) / (LONGEST - 1))
    row, column, mask = drawn(flat, low, side, BORDER)
    return Silhouette(mask, row, column, side * metres, low - BORDER * side, side)


def spacing(flat: Array) -> float:
    """Return about how far neighbours are apart, of points (N, 2) spread over an area."""
    low, high = corners(flat)
    extent = np.maximum(high - low, 1e-12)
    coarse = float(np.sqrt(extent.prod() / len(flat)))
    coarse = max(coarse, float(extent.max()) / 512)
    _, _, occupied = drawn(flat, low, coarse, 0)
    return coarse * float(np.sqrt(np.count_nonzero(occupied) / len(flat)))


@kernel
def drawn(flat: Array, low: Array, side: float, border: int) -> tuple[Indices, Indices, Mask]:
    """Return the cells of points, and the picture of all that hold one.

    Parameters
    ----------
    flat : (N, 2) array
    low : (2,) array
        Their lowest corner: it is in the first cell inside the border.
    side : float
        Of a cell, in the unit of the points.
    border : int
        Empty cells around them.

    Returns
    -------
    row, column : (N,) array
    mask : (H, W) bool array
    """
    count = flat.shape[0]
    row, column = np.empty(count, dtype=np.int64), np.empty(count, dtype=np.int64)
    for n in range(count):
        row[n] = int(np.floor((flat[n, 0] - low[0]) / side)) + border
        column[n] = int(np.floor((flat[n, 1] - low[1]) / side)) + border
    mask = np.zeros((row.max() + 1 + border, column.max() + 1 + border), dtype=np.bool_)
    for n in range(count):
        mask[row[n], column[n]] = True
    return row, column, mask
