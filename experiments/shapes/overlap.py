"""How well a superquadric is met by a box, a cylinder and a ball: intersection over union.

Each ideal body is scaled for its best IoU. Boxes and cylinders stretch with the
axes, so theirs depend on the exponents alone; a ball does not stretch, its IoU
falls with the ratio of the sizes. For exponents e2 near 2 the cross-section is a
square turned by 45 degrees, so box and cylinder are tried in the turned frame as
well; there the ratio a1 : a2 counts, as a stretched rhombus has no right angles.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_CELLS = 24
MIDDLES = (np.arange(_CELLS) + 0.5) / _CELLS
"""Of the cells along an edge of the unit octant."""

_X, _Y = np.meshgrid(MIDDLES, MIDDLES, indexing="ij")
_RING = np.minimum((np.hypot(_X, _Y) * _CELLS).astype(np.int64), 2 * _CELLS - 1).ravel()
_SQUARES = np.meshgrid(MIDDLES**2, MIDDLES**2, MIDDLES**2, indexing="ij")
_EDGES = np.arange(1, _CELLS + 1)
_BOXES = _EDGES[:, None, None] * _EDGES[None, :, None] * _EDGES[None, None, :]
# Beyond the octant's edge a circle goes on where the grid does not.
_CIRCLES = np.maximum(
    np.bincount(_RING, minlength=2 * _CELLS).cumsum(),
    np.pi / 4 * np.arange(1, 2 * _CELLS + 1) ** 2,
)
_CYLINDERS = _EDGES[:, None] * _CIRCLES[None, :]
_BALL_RADII = np.geomspace(0.05, 2.0, 160)


@dataclass(frozen=True)
class Overlaps:
    """Best IoU with each ideal body.

    Attributes
    ----------
    box : float
        Upright, or turned by 45 degrees about z.
    cylinder : float
        Elliptic, about the superquadric's own z.
    lying_cylinder : float
        Elliptic, about its x or y.
    ball : float
    """

    box: float
    cylinder: float
    lying_cylinder: float
    ball: float


def overlaps(parameters: Array) -> Overlaps:
    """Return the overlaps of [e1, e2, a1, a2, a3] (5,)."""
    e1, e2, a1, a2, a3 = (float(each) for each in parameters)
    straight = _straight(e1, e2)
    box, cylinder = _box(straight), _cylinder(straight)
    if e2 > 1:
        turned = _turned(e1, e2, a1, a2)
        box, cylinder = max(box, _box(turned)), max(cylinder, _cylinder(turned))
    return Overlaps(
        box=box,
        cylinder=cylinder,
        # x stands for y as well: with sizes of 1 the two are alike.
        lying_cylinder=_cylinder(np.moveaxis(straight, 0, 2)),
        ball=_ball(straight, np.array([a1, a2, a3]) / max(a1, a2, a3)),
    )


def _inside(e1: float, e2: float, x: Array, y: Array) -> NDArray[np.bool_]:
    """Tell which cells (G, G, G) above points (x, y) (G, G) are inside (Eq. 3.2, sizes 1)."""
    with np.errstate(over="ignore"):
        flat = (np.abs(x) ** (2 / e2) + np.abs(y) ** (2 / e2)) ** (e2 / e1)
    return np.asarray(flat[:, :, None] + MIDDLES ** (2 / e1) < 1)


def _straight(e1: float, e2: float) -> Array:
    """Return 1 for cells (G, G, G) of the unit octant that are inside, else 0."""
    return _inside(e1, e2, _X, _Y).astype(np.float64)


def _turned(e1: float, e2: float, a1: float, a2: float) -> Array:
    """Return the share (G, G, G) of cells inside, the octant turned by 45 degrees about z.

    It reaches to the superquadric's own corners. It sees one rhombus corner from
    both sides: the mean of the two mirror images stands for all.
    """
    reach = np.hypot(a1, a2) / np.sqrt(2)
    along, across = reach * (_X + _Y), reach * (_X - _Y)
    first = _inside(e1, e2, across / a1, along / a2)
    second = _inside(e1, e2, along / a1, across / a2)
    return (first.astype(np.float64) + second) / 2


def _box(inside: Array) -> float:
    shared = inside.cumsum(0).cumsum(1).cumsum(2)
    return float((shared / (shared[-1, -1, -1] + _BOXES - shared)).max())


def _cylinder(inside: Array) -> float:
    """Return the best IoU with a cylinder about the last axis."""
    flat = inside.reshape(-1, _CELLS).T
    shared = np.stack([np.bincount(_RING, weights=row, minlength=2 * _CELLS) for row in flat])
    shared = shared.cumsum(0).cumsum(1)
    return float((shared / (shared[-1, -1] + _CYLINDERS - shared)).max())


def _ball(inside: Array, sizes: Array) -> float:
    within = inside > 0
    squares = sum(size**2 * square[within] for size, square in zip(sizes, _SQUARES, strict=True))
    cell = float(np.prod(sizes)) / _CELLS**3
    shared = np.searchsorted(np.sort(squares), _BALL_RADII**2) * cell
    volume = np.pi / 6 * _BALL_RADII**3
    return float((shared / (len(squares) * cell + volume - shared)).max())
