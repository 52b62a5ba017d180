"""Name a superquadric by the ideal body that it overlaps most.

A cuboid is a box, a cylinder has an elliptic cross-section and lies along any of
the three axes, a sphere is a ball. Each ideal body is scaled for the best
intersection over union (IoU) with the superquadric. Boxes and cylinders stretch
with the axes, so theirs depend on the exponents alone; the ball does not stretch:
its IoU falls with the ratio of the sizes. For exponents e2 near 2 the
cross-section is a square turned by 45 degrees, so boxes and cylinders are tried
in the turned frame as well; there the ratio a1 : a2 counts, as a stretched
rhombus has no right angles.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.superquadric import Superquadric, inside_outside

Array = NDArray[np.float64]

CLASSES = ("cuboid", "cylinder", "sphere")

_CELLS = 24
_BALL_RADII = np.geomspace(0.05, 2.0, 160)


def class_overlaps(parameters: Array) -> Array:
    """Return the best IoU (3,) of [e1, e2, a1, a2, a3] with a cuboid, a cylinder, a sphere."""
    e1, e2 = parameters[:2]
    sizes = parameters[2:] / parameters[2:].max()
    straight = _grid(e1, e2, np.ones(3), turned=False)
    turned = _grid(e1, e2, np.array([sizes[0], sizes[1], 1.0]), turned=True)
    box = max(_box(straight), _box(turned))
    cylinder = max(_cylinder(grid, axis) for grid in (straight, turned) for axis in range(3))
    return np.array([box, cylinder, _ball(e1, e2, sizes)])


def label(parameters: Array) -> int:
    """Return the index in CLASSES of the body with the best overlap."""
    return int(np.argmax(class_overlaps(parameters)))


def _inside(e1: float, e2: float, sizes: Array, points: Array) -> NDArray[np.bool_]:
    body = Superquadric((e1, e2), tuple(sizes), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    return np.asarray(inside_outside(body, points) < 1)


class _Grid:
    """Share of the octant's cells (G, G, G) that are inside, and their middles (G,) per axis."""

    def __init__(self, inside: Array, middles: Array) -> None:
        self.inside = inside
        self.middles = middles


def _grid(e1: float, e2: float, sizes: Array, *, turned: bool) -> _Grid:
    """Sample an octant of the superquadric's bounding box, or of the box turned about z.

    A turned octant sees one rhombus corner from both sides: the mean of the two
    mirror images stands for all.
    """
    middles = (np.arange(_CELLS) + 0.5) / _CELLS
    x, y, z = (axis.ravel() for axis in np.meshgrid(middles, middles, middles, indexing="ij"))
    if not turned:
        inside = _inside(e1, e2, sizes, np.column_stack([x, y, z])).astype(np.float64)
    else:
        # Reach of the turned axes: no farther than the superquadric's own corners.
        reach = np.hypot(sizes[0], sizes[1])
        u, v = reach * (x - y) / np.sqrt(2), reach * (x + y) / np.sqrt(2)
        w, t = reach * (x + y) / np.sqrt(2), reach * (y - x) / np.sqrt(2)
        first = _inside(e1, e2, sizes, np.column_stack([u, v, z]))
        second = _inside(e1, e2, sizes, np.column_stack([w, t, z]))
        inside = (first.astype(np.float64) + second) / 2
    return _Grid(inside.reshape(_CELLS, _CELLS, _CELLS), middles)


def _box(grid: _Grid) -> float:
    shared = grid.inside.cumsum(0).cumsum(1).cumsum(2)
    edge = np.arange(1, _CELLS + 1)
    volume = edge[:, None, None] * edge[None, :, None] * edge[None, None, :]
    return float((shared / (shared[-1, -1, -1] + volume - shared)).max())


def _cylinder(grid: _Grid, axis: int) -> float:
    inside = np.moveaxis(grid.inside, axis, 0)
    radius = np.hypot(grid.middles[:, None], grid.middles[None, :])
    ring = np.minimum((radius * _CELLS).astype(int), 2 * _CELLS - 1).ravel()
    flat = inside.reshape(_CELLS, -1)
    count = 2 * _CELLS
    shared = np.stack([np.bincount(ring, weights=row, minlength=count) for row in flat])
    area = np.bincount(ring, minlength=count).cumsum()
    shared = shared.cumsum(0).cumsum(1)
    # Beyond the octant's edge the circle goes on where the grid does not.
    full = np.pi / 4 * np.arange(1, count + 1) ** 2
    area = np.maximum(area, full)
    volume = np.arange(1, _CELLS + 1)[:, None] * area[None, :]
    return float((shared / (shared[-1, -1] + volume - shared)).max())


def _ball(e1: float, e2: float, sizes: Array) -> float:
    middles = (np.arange(_CELLS) + 0.5) / _CELLS
    x, y, z = (axis.ravel() for axis in np.meshgrid(middles, middles, middles, indexing="ij"))
    points = np.column_stack([x, y, z])
    inside = _inside(e1, e2, np.ones(3), points)
    cell = float(np.prod(sizes)) / _CELLS**3
    radius = np.linalg.norm(points * sizes, axis=1)[inside]
    shared = np.searchsorted(np.sort(radius), _BALL_RADII) * cell
    volume = np.pi / 6 * _BALL_RADII**3
    return float((shared / (inside.sum() * cell + volume - shared)).max())
