"""Random numbers that depend on what they are for, not on when they are drawn."""

from __future__ import annotations

import hashlib

import numpy as np


def generator(seed: int, purpose: str, index: int) -> np.random.Generator:
    """Return the generator of a seed for a purpose, such as the scene of an object's view."""
    key = int.from_bytes(hashlib.sha256(purpose.encode()).digest()[:16], "little")
    return np.random.default_rng([seed, key, index])
