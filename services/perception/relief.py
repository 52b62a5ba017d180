"""What stands out of a plane, down to a few times the noise of a single point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from services.perception.noise import SIGMA_PER_MEDIAN, NoiseProfile
from services.perception.plane import Plane
from services.perception.settings import PerceptionSettings

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_MARGIN_M = 0.05
_MAX_CELLS = 1_000_000
_EVERY = 5
_EIGHT = np.ones((3, 3), dtype=bool)


@dataclass(frozen=True)
class _Grid:
    """Square cells over the seen piece of a plane, row-major in u, v."""

    low: Array
    cell: float
    shape: tuple[int, int]

    @classmethod
    def over(cls, plane: Plane, spacing: float, finest: float) -> _Grid:
        low = plane.box[0] - _MARGIN_M
        extent = plane.box[1] + _MARGIN_M - low
        cell = max(finest, spacing, float(np.sqrt(extent.prod() / _MAX_CELLS)))
        rows, columns = np.ceil(extent / cell).astype(int)
        return cls(low, cell, (int(rows), int(columns)))

    def locate(self, points: Array, basis: Array) -> tuple[NDArray[np.int64], Mask]:
        """Return the cell (N,) over which points (N, 3) stand, and whether it exists."""
        cells = np.zeros(len(points), dtype=np.int64)
        inside = np.ones(len(points), dtype=bool)
        for axis in (0, 1):
            place = points @ (basis[:, axis] / self.cell)
            place -= self.low[axis] / self.cell
            inside &= (place >= 0) & (place < self.shape[axis])
            np.clip(place, 0, self.shape[axis], out=place)
            cells *= self.shape[axis]
            cells += place.astype(np.int64)
        return cells, inside

    def ranges(self, foot: Array, distance: float) -> Array:
        """Return the range of each cell from a sensor `distance` above the point `foot`."""
        u = self.low[0] + (np.arange(self.shape[0]) + 0.5) * self.cell - foot[0]
        v = self.low[1] + (np.arange(self.shape[1]) + 0.5) * self.cell - foot[1]
        return np.asarray(np.sqrt(u[:, None] ** 2 + v[None, :] ** 2 + distance**2))


def relief(
    plane: Plane,
    points: Array,
    heights: Array,
    viewpoint: Array,
    noise: NoiseProfile,
    sigmas: Array,
    settings: PerceptionSettings,
) -> Mask:
    """Tell which points stand out of the plane towards the sensor.

    Averaged over a small window, a 3 mm thing is clear of 1.5 mm noise although no single
    point of it is. So heights are averaged over 3x3 windows of a grid in the plane; a
    window's mean counts in units of its standard error, which is scaled up to the scatter
    that the plane's windows really show, so that correlated noise is not taken for relief.
    Windows that are certain are grown into the weaker ones joined to them (hysteresis),
    which keeps a thin blade with its handle. Within them each point is then told from the
    plane by its own height.

    Parameters
    ----------
    plane : Plane
        The surface.
    points, heights : (N, 3), (N,) arrays
        Metres; heights over the plane.
    viewpoint : (3,) array
        Position of the sensor.
    noise : NoiseProfile
        Of single heights, by range.
    sigmas : (N,) array
        The profile at the points' ranges.

    Returns
    -------
    (N,) array of bool
    """
    tall = np.maximum(4 * settings.seed_height_m, 8 * sigmas)
    standing = heights > tall
    spacing = float(np.sqrt(plane.area / max(1.0, plane.share * len(points))))
    grid = _Grid.over(plane, spacing, settings.cell_m)
    cells, inside = grid.locate(points, plane.basis)
    used = np.flatnonzero(inside & (heights > -3 * sigmas - settings.grow_height_m))
    cells = cells[used]
    capped = np.minimum(heights[used], tall[used])
    mean, count = _window_means(cells, capped, grid.shape)
    ranges = grid.ranges(viewpoint @ plane.basis, float(plane.heights(viewpoint)))
    kept = _certain_patches(mean, count, noise.at(ranges), settings)
    top = _gather(np.maximum, np.where(kept, mean, 0.0))
    chosen = np.flatnonzero(kept.ravel()[cells])
    rows, cells = used[chosen], cells[chosen]
    least = _threshold(top.ravel()[cells], mean.ravel()[cells], sigmas[rows], settings)
    standing[rows[heights[rows] > least]] = True
    return standing


def _threshold(top: Array, mean: Array, sigma: Array, settings: PerceptionSettings) -> Array:
    """Return the height (K,) above which a point belongs to the relief, not to the plane.

    Between two normal distributions of deviation `sigma` about 0 and `top` the likelier
    one changes at top / 2 - sigma^2 / top * log(p / (1 - p)), p the prior share of the
    upper one. The window's mean over `top` stands for p, but sees past the relief's edge,
    so only half of the prior's term is used. No single point needs to be higher than the
    noise reaches.
    """
    share = np.clip(mean / top, 0.02, 0.98)
    prior = 0.5 * sigma**2 / top * np.log(share / (1.0 - share))
    enough = np.maximum(settings.point_height_m, settings.point_sigmas * sigma)
    return np.maximum(np.minimum(0.5 * top, enough) - prior, -sigma)


def _window_means(
    cells: NDArray[np.int64], heights: Array, shape: tuple[int, int]
) -> tuple[Array, Array]:
    """Return mean height and number of points of the 3x3 window around each cell."""
    size = shape[0] * shape[1]
    number = np.asarray(np.bincount(cells, minlength=size), dtype=np.float64)
    total = np.asarray(np.bincount(cells, heights, size), dtype=np.float64)
    counts = _gather(np.add, number.reshape(shape))
    totals = _gather(np.add, total.reshape(shape))
    return np.divide(totals, counts, out=np.zeros(shape), where=counts > 0), counts


def _gather(combine: np.ufunc, grid: Array) -> Array:
    """Return each cell combined with its eight neighbours, by sum or maximum."""
    for axis in (0, 1):
        lines = np.moveaxis(grid.copy(), axis, 0)
        source = np.moveaxis(grid, axis, 0)
        combine(lines[1:], source[:-1], out=lines[1:])
        combine(lines[:-1], source[1:], out=lines[:-1])
        grid = np.moveaxis(lines, 0, axis)
    return grid


def _certain_patches(mean: Array, count: Array, sigma: Array, settings: PerceptionSettings) -> Mask:
    """Return the windows that surely stand out, with the weaker ones joined to them."""
    significance = mean * np.sqrt(count) / sigma
    seen = np.abs(significance[count > 0][::_EVERY])
    if len(seen):
        significance /= max(1.0, SIGMA_PER_MEDIAN * float(np.median(seen)))
    weak = (mean > settings.grow_height_m) & (significance > settings.grow_sigmas)
    sure = weak & (mean > settings.seed_height_m) & (significance > settings.seed_sigmas)
    sure &= count > 1
    patches, highest = ndimage.label(weak, _EIGHT)
    certain = np.zeros(highest + 1, dtype=bool)
    certain[patches[sure]] = True
    return np.asarray(certain[patches])
