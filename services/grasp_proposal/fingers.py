"""Points inside the fingers of placed hands."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.contacts import Contacts
from services.grasp_proposal.hand import Hand
from shared.jit import kernel

Array = NDArray[np.float64]

ACROSS = (-0.4, 0.4)
"""Shares of a finger's width, from its middle, where it is sampled."""


def finger_samples(
    hand: Hand, contacts: Contacts, sign: float, through: Sequence[float], deep: Sequence[float]
) -> tuple[Array, Array]:
    """Return points (G, K, 3) inside one finger of G hands, and how far from its tip they are (K,).

    Parameters
    ----------
    sign : float
        -1 the left finger, +1 the right one.
    through, deep : sequence of float
        Shares of its thickness, from the pad, and of its length, from the tip.
    """
    placed = contacts.placed
    xs = np.array(ACROSS) * hand.finger_width
    ys = np.array(through) * hand.finger_thickness
    zs = -np.array(deep) * hand.finger_length
    grid = np.stack(np.meshgrid(xs, ys, zs, indexing="ij"), axis=-1).reshape(-1, 3)
    middle = (placed.left + placed.right) / 2
    return _moved(
        grid, placed.origin, placed.rotation, middle, contacts.opening, placed.tip, sign
    ), -grid[:, 2]


@kernel
def _moved(
    grid: Array,
    origin: Array,
    rotation: Array,
    middle: Array,
    opening: Array,
    tip: Array,
    sign: float,
) -> Array:
    """Return the points (K, 3) of a finger's grid in the workspace, for each of G hands."""
    points = np.empty((len(origin), len(grid), 3))
    for g in range(len(origin)):
        for k in range(len(grid)):
            x = grid[k, 0]
            y = middle[g] + sign * (opening[g] / 2 + grid[k, 1])
            z = grid[k, 2] + tip[g]
            for i in range(3):  # x, z, y: the order in which NumPy's einsum adds
                r = rotation[g, i]
                points[g, k, i] = origin[g, i] + (r[0] * x + r[2] * z + r[1] * y)
    return points
