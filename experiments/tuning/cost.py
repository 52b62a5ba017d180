"""How far recovered primitives are from the expected ones: Eq. A.1 to A.3 of the thesis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import linear_sum_assignment

from experiments.tuning.expected import ExpectedPrimitive

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ViewCost:
    """What the primitives of one view cost.

    Attributes
    ----------
    size, spatial : float or None
        Errors of Eq. A.1 and A.2, in [0, 1]; None where the number of primitives
        is not the expected one.
    """

    size: float | None = None
    spatial: float | None = None

    @property
    def total(self) -> float:
        """Eq. A.3: the mean of both, or 1 for a wrong number of primitives."""
        if self.size is None or self.spatial is None:
            return 1.0
        return (self.size + self.spatial) / 2


def view_cost(
    sizes: ArrayLike, positions: ArrayLike, expected: Sequence[ExpectedPrimitive]
) -> ViewCost:
    """Return the cost of recovered primitives.

    Both errors are sums of lengths in metres under a hyperbolic tangent: 0.1 stands
    for 0.1 m all in all. Which primitive stands for which expected one is decided by
    the sizes, and kept for the positions. The difference of positions is taken
    between every two primitives, so that where the whole object is does not matter.

    Parameters
    ----------
    sizes : (P, 3) array_like
        Edge lengths of the recovered primitives in any order, metres.
    positions : (P, 3) array_like
        Their centres in the object's frame, metres.
    expected : sequence of ExpectedPrimitive
    """
    found = np.asarray(sizes, dtype=np.float64).reshape(-1, 3)
    places = np.asarray(positions, dtype=np.float64).reshape(-1, 3)
    if len(found) != len(expected):
        return ViewCost()
    differences = size_differences(found, np.array([each.size for each in expected]))
    mine, theirs = linear_sum_assignment(differences)
    wanted = np.array([each.position for each in expected])[theirs]
    first, second = np.triu_indices(len(expected), k=1)
    offset = (places[mine][second] - places[mine][first]) - (wanted[second] - wanted[first])
    return ViewCost(
        size=float(np.tanh(differences[mine, theirs].sum())),
        spatial=float(np.tanh(np.abs(offset).sum())),
    )


def size_differences(found: Array, expected: Array) -> Array:
    """Return how much every found size (P, 3) differs from every expected one (E, 3): (P, E).

    The axes of a primitive have no order, so the assignment of its edges that
    makes the sum of absolute differences smallest counts. That one goes from the
    shortest to the shortest edge, and so on.
    """
    ascending = np.sort(found, axis=1)[:, None, :] - np.sort(expected, axis=1)[None, :, :]
    return np.asarray(np.abs(ascending).sum(axis=2))
