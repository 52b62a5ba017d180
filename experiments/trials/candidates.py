"""Which of the answered grasps are tried: good ones, bad ones, and some that are a little off."""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]

OFF = 0.3
"""Share of the grasps that are moved."""
SHIFT = 0.003
TURN = np.radians(4.0)
"""Standard deviations of the move, metres along and radians about each axis."""


class Tried(NamedTuple):
    """Grasps to be tried.

    Attributes
    ----------
    grasps : (K, 9) array
        As in the answer.
    rank : (K,) array
        In the answer, 0 the best.
    moved : (K,) bool array
        Moved away from where the answer has it.
    """

    grasps: Array
    rank: NDArray[np.intp]
    moved: NDArray[np.bool_]


def spread(grasps: Array, number: int, rng: np.random.Generator) -> Tried:
    """Return `number` of the grasps (G, 9): the best, and one of each stratum.

    The others are cut by rank into strata of equal size, one of each is drawn. Some
    of them, never the best, are moved by a few millimetres and degrees.
    """
    if len(grasps) <= number:
        rank = np.arange(len(grasps))
    else:
        borders = np.linspace(1, len(grasps), number).astype(np.intp)
        others = [rng.integers(low, high) for low, high in itertools.pairwise(borders)]
        rank = np.array([0, *others], dtype=np.intp)
    chosen = grasps[rank].copy()
    moved = (rng.random(len(chosen)) < OFF) & (rank > 0)
    for row in np.flatnonzero(moved):
        chosen[row, :3] += rng.normal(0.0, SHIFT, 3)
        turn = Rotation.from_rotvec(rng.normal(0.0, TURN, 3))
        chosen[row, 3:7] = (turn * Rotation.from_quat(chosen[row, 3:7])).as_quat()
    return Tried(chosen, rank, moved)
