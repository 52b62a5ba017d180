"""What stands out of a plane, down to a few times the noise of a single point."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from services.perception.median import median
from services.perception.noise import SIGMA_PER_MEDIAN, NoiseProfile
from services.perception.pixels import distances, heights_above
from services.perception.plane import SAMPLE, Plane
from services.perception.relief_map import (
    grow,
    highest_around,
    points_over,
    survey,
    window_means,
)
from services.perception.settings import PerceptionSettings

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Cells = NDArray[np.integer[Any]]

_MARGIN_M = 0.05
_MAX_CELLS = 1_000_000


@dataclass(frozen=True)
class _Grid:
    """Square cells over the seen piece of a plane, row-major in u, v, with an empty rim.

    `origin` (2,) is where the first cell inside the rim begins.
    """

    origin: Array
    cell: float
    shape: tuple[int, int]

    @classmethod
    def over(cls, plane: Plane, spacing: float, finest: float) -> _Grid:
        low = plane.box[0] - _MARGIN_M
        extent = plane.box[1] + _MARGIN_M - low
        cell = max(finest, spacing, float(np.sqrt(extent.prod() / _MAX_CELLS)))
        rows, columns = np.ceil(extent / cell).astype(int) + 2
        return cls(low, cell, (int(rows), int(columns)))

    def ranges(self, cells: Cells, foot: Array, distance: float) -> Array:
        """Return the range of cells (K,) from a sensor `distance` above the point `foot`."""
        rows, columns = np.divmod(cells, self.shape[1])
        u = self.origin[0] + (rows - 0.5) * self.cell - foot[0]
        v = self.origin[1] + (columns - 0.5) * self.cell - foot[1]
        return np.asarray(np.sqrt(u**2 + v**2 + distance**2))


def relief(
    plane: Plane,
    points: Array,
    viewpoint: Array,
    noise: NoiseProfile,
    settings: PerceptionSettings,
) -> tuple[Mask, Mask]:
    """Tell which points stand out of the plane towards the sensor, and which lie on it.

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
    points : (N, 3) array
        Metres.
    viewpoint : (3,) array
        Position of the sensor.
    noise : NoiseProfile
        Of single heights, by range.

    Returns
    -------
    standing, lying : (N,) arrays of bool
    """
    tall = 4 * settings.seed_height_m
    spacing = float(np.sqrt(plane.area / max(1.0, plane.share * len(points))))
    grid = _Grid.over(plane, spacing, settings.cell_m)
    limits = settings.grow_height_m, tall, settings.plane_tolerance_m
    axes = np.ascontiguousarray(plane.basis.T) / grid.cell
    origin = grid.origin / grid.cell
    level = np.ascontiguousarray(plane.normal), plane.offset
    cells, sums, standing, lying = survey(
        points, level, viewpoint, (noise.ranges, noise.sigmas), limits, axes, origin, *grid.shape
    )
    count, mean = window_means(sums)
    sensor = viewpoint @ plane.basis, float(plane.heights(viewpoint))
    kept = _certain_patches(mean, count, lambda of: noise.at(grid.ranges(of, *sensor)), settings)
    rows = points_over(cells, kept)
    over, cells = points.take(rows, axis=0), cells.take(rows)
    least = _threshold(
        highest_around(cells, mean, kept),
        mean.ravel().take(cells),
        noise.at(distances(over, viewpoint)),
        settings,
    )
    standing[rows[heights_above(over, *level) > least]] = True
    return standing, lying & ~standing


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


def _certain_patches(
    mean: Array, count: Array, sigmas: Callable[[Cells], Array], settings: PerceptionSettings
) -> Mask:
    """Return the windows that surely stand out, with the weaker ones joined to them.

    `sigmas` gives the deviation of a single height over each of some cells.
    """
    means, counts = mean.ravel(), count.ravel()

    def significance(cells: Cells) -> Array:
        return np.asarray(means[cells] * np.sqrt(counts[cells]) / sigmas(cells))

    seen = np.arange(0, len(counts), 1 + len(counts) // SAMPLE)
    seen = seen[counts[seen] > 0]
    scatter = 1.0
    if len(seen):
        scatter = max(1.0, SIGMA_PER_MEDIAN * median(np.abs(significance(seen))))
    high = np.flatnonzero(means > settings.grow_height_m)
    clear = significance(high) / scatter
    certain = (means[high] > settings.seed_height_m) & (clear > settings.seed_sigmas)
    certain &= counts[high] > 1
    weak, sure = np.zeros((2, *mean.shape), dtype=np.bool_)
    weak.ravel()[high] = clear > settings.grow_sigmas
    sure.ravel()[high] = certain & (clear > settings.grow_sigmas)
    return grow(sure, weak)
