"""How far two parts that meet look like two pieces of one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.reasoning.span import support
from shared.superquadric import Superquadric

Array = NDArray[np.float64]


class Continuity(NamedTuple):
    """Of two parts.

    Attributes
    ----------
    likeness : float
        Cross-section of the slimmer over that of the stouter, across the line that joins
        them: the smaller of the two ratios. 1 where one goes on as the other ends.
    filling : float
        How much of the box around both their own boxes fill. Near 1 in line, less where
        they are apart, at an angle or of different size; above 1 where they overlap.
    bend : float
        Angle between their longest axes, 0 to 90 degrees.
    """

    likeness: float
    filling: float
    bend: float


def continuity(one: Superquadric, other: Superquadric) -> Continuity:
    """Return how far two parts continue each other.

    Both are boxed along the axes of the one and along those of the other; of the two, the
    likeness is the mean and the filling the smaller.
    """
    (likeness, filling), (again, other_filling) = _seen_by(one, other), _seen_by(other, one)
    parallel = min(1.0, abs(float(_longest_axis(one) @ _longest_axis(other))))
    return Continuity(
        (likeness + again) / 2, min(filling, other_filling), float(np.degrees(np.arccos(parallel)))
    )


def _longest_axis(shape: Superquadric) -> Array:
    return np.asarray(shape.rotation[:, int(np.argmax(shape.full_extents))])


def _seen_by(one: Superquadric, other: Superquadric) -> tuple[float, float]:
    frame = one.rotation
    low, high = boxes((one, other), frame)
    joining = int(np.maximum(low[1] - high[0], low[0] - high[1]).argmax())
    size = high - low
    across = np.delete(size, joining, axis=1)
    likeness = float((across.min(axis=0) / across.max(axis=0)).min())
    common = high.max(axis=0) - low.min(axis=0)
    return likeness, float(size.prod(axis=1).sum() / common.prod())


def boxes(shapes: Sequence[Superquadric], frame: Array) -> tuple[Array, Array]:
    """Return lowest and highest corner (P, 3) of the box around each shape along a frame's axes.

    Parameters
    ----------
    shapes : sequence of Superquadric
    frame : (3, 3) array
        Its columns are the axes.
    """
    middle = np.array([shape.position for shape in shapes]) @ frame
    half = np.array([support(shape, frame) for shape in shapes])
    return middle - half, middle + half
