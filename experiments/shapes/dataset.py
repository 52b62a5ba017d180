"""Random superquadrics."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

EXPONENTS = (0.1, 2.0)
SEMI_AXES = (0.01, 0.15)
"""Metres; the ranges of A.1.2."""


def thesis_superquadrics(count: int, rng: np.random.Generator) -> Array:
    """Return parameters (count, 5) of [e1, e2, a1, a2, a3], uniform as in A.1.2."""
    return np.hstack([rng.uniform(*EXPONENTS, (count, 2)), rng.uniform(*SEMI_AXES, (count, 3))])


def random_superquadrics(count: int, rng: np.random.Generator) -> Array:
    """Return parameters (count, 5) of [e1, e2, a1, a2, a3], of all kinds that are met.

    Exponents are uniform over their range, one in ten at its end, where the
    recovery's bounds put many. Of the sizes a third is uniform as in A.1.2, a
    third logarithmic, for the thin ones among recovered parts, and a third alike,
    for the narrow border between spheres and the rest.
    """
    exponents = rng.uniform(*EXPONENTS, (count, 2))
    at_end = rng.random((count, 2)) < 0.1
    exponents[at_end] = rng.choice(EXPONENTS, int(at_end.sum()))
    uniform = rng.uniform(*SEMI_AXES, (count, 3))
    thin = SEMI_AXES[1] * np.exp(rng.uniform(np.log(0.01), 0.0, (count, 3)))
    alike = rng.uniform(0.03, 0.1, (count, 1)) * rng.uniform(0.7, 1.3, (count, 3))
    sizes = np.choose(rng.integers(3, size=(count, 1)), [uniform, thin, alike])
    return np.hstack([exponents, sizes])
