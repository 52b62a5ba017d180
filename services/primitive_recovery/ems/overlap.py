"""Overlap removal: Algorithm 2 of the thesis."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from shared.superquadric import Superquadric, volume

Array = NDArray[np.float64]

VOLUME_SAMPLES = 5000
"""The thesis's number, or as many of the cube's points as the body holds."""
THRESHOLD = 0.5

_CUBE_SAMPLES = 2**15
"""A power of two, as Sobol points want it; the leanest body, an octahedron, holds a sixth."""


def kept_after_overlap(superquadrics: Sequence[Superquadric]) -> tuple[int, ...]:
    """Return the indices of the superquadrics that Algorithm 2 keeps, in order.

    overlap(j, i) is the share of j's volume inside i, on 5,000 samples of j's volume.
    j goes if it exceeds one half for some i; where it does both ways, the one with
    the larger share goes. Both shares have the same intersection above the line,
    so that is the one with the smaller volume, and the largest of all always
    stays; of two alike, the later one goes.
    """
    count = len(superquadrics)
    if count < 2:
        return tuple(range(count))
    volumes = np.array([volume(one) for one in superquadrics])
    share = overlap_shares(superquadrics)
    np.fill_diagonal(share, 0.0)
    rank = np.lexsort((-np.arange(count), volumes)).argsort()
    smaller = rank[:, None] < rank[None, :]
    goes = (share > THRESHOLD) & ((share.T <= THRESHOLD) | smaller)
    return tuple(np.flatnonzero(~goes.any(axis=1)).tolist())


def overlap_shares(superquadrics: Sequence[Superquadric]) -> Array:
    """Return (P, P): the share of the row's volume that is inside the column's body."""
    rotations = np.stack([one.rotation for one in superquadrics])
    positions = np.array([one.position for one in superquadrics])
    semi_axes = np.array([one.semi_axes for one in superquadrics])[:, None]
    e1, e2 = np.array([one.exponents for one in superquadrics]).T[..., None]
    share = np.empty((len(superquadrics), len(superquadrics)))
    for row, one in zip(share, superquadrics, strict=True):
        offsets = volume_samples(one) - positions[:, None]
        x, y, z = np.moveaxis(np.abs(offsets @ rotations) / semi_axes, -1, 0)
        row[:] = _inside(x, y, z, e1, e2).mean(axis=-1)
    return share


def volume_samples(superquadric: Superquadric, count: int = VOLUME_SAMPLES) -> Array:
    """Return points (count, 3) spread evenly over the volume, the same each time.

    The Sobol points of its box that are inside of it (quasi-random: their share in a
    region converges about as 1 / n, that of random ones as 1 / sqrt(n)).
    """
    e1, e2 = superquadric.exponents
    x, y, z = np.abs(_cube()).T
    chosen = _cube()[_inside(x, y, z, e1, e2)][:count]
    return superquadric.to_outer(chosen * superquadric.semi_axes)


def _inside(
    x: Array, y: Array, z: Array, e1: Array | float, e2: Array | float
) -> NDArray[np.bool_]:
    """Return where |coordinates| in semi-axes are inside (`shared.superquadric.inside_outside`)."""
    with np.errstate(over="ignore"):
        flat = (x ** (2 / e2) + y ** (2 / e2)) ** (e2 / e1)
        return np.asarray(flat + z ** (2 / e1) < 1)


@lru_cache(maxsize=1)
def _cube() -> Array:
    """Return Sobol points (N, 3) in the cube from -1 to 1."""
    return np.asarray(2 * qmc.Sobol(3, scramble=False).random(_CUBE_SAMPLES) - 1)
