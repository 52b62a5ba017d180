"""Random measures for variants."""

from __future__ import annotations

import numpy as np


def around(rng: np.random.Generator, value: float, spread: float) -> float:
    """Return a measure near `value`: log-normal, `spread` its relative deviation, cut at two."""
    return value * float(np.exp(spread * np.clip(rng.standard_normal(), -2, 2)))


def between(rng: np.random.Generator, low: float, high: float) -> float:
    """Return a measure from `low` to `high`, all equally likely."""
    return float(rng.uniform(low, high))
