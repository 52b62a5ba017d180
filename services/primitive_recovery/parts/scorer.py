"""How good a cut is, as a small network trained on random objects tells it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]

MODELS = Path(__file__).parent.parent / "model"

_FARTHEST = 4.0
"""Standard deviations at which a feature is cut off: objects unlike all trained on
are judged by what they share with them."""


@dataclass(frozen=True)
class Scorer:
    """Networks of fully connected layers with rectifiers, averaged.

    Attributes
    ----------
    mean, deviation : (F,) array
        Of the features in training.
    networks : tuple of tuples of (weights (I, O), bias (O,))
    """

    mean: Array
    deviation: Array
    networks: tuple[tuple[tuple[Array, Array], ...], ...]

    @classmethod
    def load(cls, path: Path) -> Scorer:
        """Return the scorer in a file of plain numbers (experiments/parts writes it)."""
        with np.load(path, allow_pickle=False) as held:
            networks = []
            for n in range(int(held["networks"])):
                layers = int(held["layers"])
                networks.append(
                    tuple(
                        (
                            held[f"weights_{n}_{k}"].astype(np.float64),
                            held[f"bias_{n}_{k}"].astype(np.float64),
                        )
                        for k in range(layers)
                    )
                )
            return cls(
                held["mean"].astype(np.float64),
                held["deviation"].astype(np.float64),
                tuple(networks),
            )

    def __call__(self, features: Array) -> Array:
        """Return the expected quality (N,) of cuts with features (N, F).

        It stands for the worse of the two overlaps (IoU) between the cut's sides
        and the regions that people hold; 0 where an object is better left whole.
        """
        scaled = standardized(features, self.mean, self.deviation, _FARTHEST)
        total = np.zeros(len(features))
        for layers in self.networks:
            held = scaled
            for weights, bias in layers[:-1]:
                held = rectified(held @ weights, bias)
            weights, bias = layers[-1]
            total += (held @ weights + bias)[:, 0]
        return total / len(self.networks)


@kernel
def standardized(features: Array, mean: Array, deviation: Array, farthest: float) -> Array:
    """Return features (N, F) in deviations (F,) from their mean (F,), `farthest` at most."""
    out = np.empty(features.shape)
    for n in range(features.shape[0]):
        for f in range(features.shape[1]):
            value = (features[n, f] - mean[f]) / deviation[f]
            out[n, f] = min(max(value, -farthest), farthest)
    return out


@kernel
def rectified(values: Array, bias: Array) -> Array:
    """Return values (N, U) plus a bias (U,), 0 where that is negative."""
    out = np.empty(values.shape)
    for n in range(values.shape[0]):
        for u in range(values.shape[1]):
            out[n, u] = max(values[n, u] + bias[u], 0.0)
    return out
