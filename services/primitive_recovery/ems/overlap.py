"""Overlap removal: Algorithm 2 of the thesis."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from shared.superquadric import Superquadric, inside_outside, volume

Array = NDArray[np.float64]

VOLUME_SAMPLES = 5000
THRESHOLD = 0.5


def kept_after_overlap(
    superquadrics: Sequence[Superquadric], rng: np.random.Generator
) -> tuple[int, ...]:
    """Return the indices of the superquadrics that Algorithm 2 keeps, in order.

    overlap(j, i) is the share of j's volume inside i, on 5,000 samples of j's volume.
    j goes if it exceeds one half for some i; where it does both ways, the one with
    the larger share goes. Both shares have the same intersection above the line,
    so that is the one with the smaller volume, and the largest of all always
    stays; of two alike, the later one goes.
    """
    volumes = [volume(one) for one in superquadrics]
    count = len(superquadrics)
    share = np.zeros((count, count))
    for j in range(count):
        samples = volume_samples(superquadrics[j], VOLUME_SAMPLES, rng)
        for i in range(count):
            if i != j:
                share[j, i] = (inside_outside(superquadrics[i], samples) < 1).mean()

    def goes(j: int, i: int) -> bool:
        if i == j or share[j, i] <= THRESHOLD:
            return False
        return share[i, j] <= THRESHOLD or (volumes[j], -j) < (volumes[i], -i)

    return tuple(j for j in range(count) if not any(goes(j, i) for i in range(count)))


def volume_samples(superquadric: Superquadric, count: int, rng: np.random.Generator) -> Array:
    """Return points (count, 3) spread evenly over the volume, by rejection from its box."""
    e1, e2 = superquadric.exponents
    accepted: list[Array] = []
    missing = count
    unit = Superquadric((e1, e2), (1.0, 1.0, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    expected = volume(unit) / 8  # at least a sixth: e1 = e2 = 2, an octahedron
    while missing > 0:
        cube = rng.uniform(-1.0, 1.0, (int(1.1 * missing / expected) + 32, 3))
        inside = cube[inside_outside(unit, cube) < 1][:missing]
        accepted.append(inside)
        missing -= len(inside)
    return superquadric.to_outer(np.concatenate(accepted) * superquadric.semi_axes)
