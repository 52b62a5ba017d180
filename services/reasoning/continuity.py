"""How far two parts that meet look like two pieces of one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.reasoning.bodies import Bodies

Array = NDArray[np.float64]
Index = NDArray[np.intp]


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


def continuities(bodies: Bodies, pairs: Sequence[tuple[int, int]]) -> tuple[Continuity, ...]:
    """Return how far the two parts of each pair, two of `bodies`, continue each other.

    Both are boxed along the axes of the one and along those of the other; of the two, the
    likeness is the mean and the filling the smaller.
    """
    if not pairs:
        return ()
    low, high = bodies.boxes(bodies.rotations)
    one, other = np.array(pairs).T
    there_and_back = np.concatenate([one, other]), np.concatenate([other, one])
    likeness, filling = (each.reshape(2, -1) for each in _seen_by(low, high, *there_and_back))
    longest = bodies.rotations[np.arange(len(low)), :, bodies.semi_axes.argmax(axis=1)]
    parallel = np.minimum(np.abs((longest[one] * longest[other]).sum(axis=1)), 1.0)
    found = (
        likeness.mean(axis=0),
        filling.min(axis=0),
        np.degrees(np.arccos(parallel)),
    )
    return tuple(map(Continuity._make, np.stack(found, axis=1).tolist()))


def _seen_by(low: Array, high: Array, one: Index, other: Index) -> tuple[Array, Array]:
    """Return likeness and filling (M,) of pairs, boxed along the axes of the first of each."""
    low, high = (np.stack([each[one, one], each[other, one]]) for each in (low, high))
    joining = np.maximum(low[1] - high[0], low[0] - high[1]).argmax(axis=1)
    size = high - low
    alike = size.min(axis=0) / size.max(axis=0)
    alike[np.arange(len(one)), joining] = np.inf
    common = high.max(axis=0) - low.min(axis=0)
    return alike.min(axis=1), size.prod(axis=2).sum(axis=0) / common.prod(axis=1)
