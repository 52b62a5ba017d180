"""Points inside the fingers of placed hands."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.contacts import Contacts
from services.grasp_proposal.hand import Hand

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
    centre = (placed.left + placed.right) / 2
    local = np.broadcast_to(grid, (len(centre), *grid.shape)).copy()
    local[:, :, 1] = centre[:, None] + sign * (contacts.opening[:, None] / 2 + grid[:, 1])
    local[:, :, 2] += placed.tip[:, None]
    return placed.origin[:, None] + np.einsum("gij,gkj->gki", placed.rotation, local), -grid[:, 2]
