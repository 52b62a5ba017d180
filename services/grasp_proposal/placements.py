"""Hands with a place: what the search hands on to the closer look."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Placements:
    """Hands with a place, one row each, coordinates in the workspace.

    Attributes
    ----------
    rotation : (G, 3, 3) array
        Columns x, y (closing), z (approach).
    origin : (G, 3) array
        The surface point that the hand was tried at.
    tip : (G,) array
        How far the finger tips reach past the origin along z.
    left, right : (G,) arrays
        Edges of the part along y, from the origin, left < right.
    front : (G,) array
        Where the part begins along z.
    """

    rotation: Array
    origin: Array
    tip: Array
    left: Array
    right: Array
    front: Array

    def take(self, chosen: NDArray[np.intp] | Mask) -> Placements:
        """Return the chosen rows."""
        return Placements(*(getattr(self, each.name)[chosen] for each in fields(self)))

    @classmethod
    def concatenated(cls, several: Sequence[Placements]) -> Placements:
        """Return the rows of several, one after the other."""
        names = [each.name for each in fields(cls)]
        return cls(*(np.concatenate([getattr(each, name) for each in several]) for name in names))

    def __len__(self) -> int:
        return len(self.tip)
