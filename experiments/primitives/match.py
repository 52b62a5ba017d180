"""Recovered parts against a labelled region: the best one, and the best several."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Mask = NDArray[np.bool_]
Labels = NDArray[np.int16]


@dataclass(frozen=True)
class Match:
    """What could be had of a region by choosing among the parts, with the label in hand.

    Attributes
    ----------
    part : int or None
        The part that overlaps the region most; None where there are no parts.
    single : float
        Its intersection over union with the region.
    union : float
        The best intersection over union of any set of parts.
    """

    part: int | None
    single: float
    union: float


def match(point_primitive: Labels, truth: Mask) -> Match:
    """Return the best choices of parts for a region.

    Both are exact. The best set holds the parts in the order of their precision, as
    far as one more part still gains: hits over (region + false points) is a ratio of
    two sums over the parts, and such a ratio is largest for all parts above a
    threshold of hits per false point.

    Parameters
    ----------
    point_primitive : (N,) int16 array
        Part of each of the object's points; -1 for none.
    truth : (N,) bool array
        The region, at least one point.

    Raises
    ------
    ValueError
        The arrays differ in length, or the region is empty.
    """
    if point_primitive.shape != truth.shape or not truth.any():
        raise ValueError("a region of at least one of the object's points is needed")
    assigned = point_primitive >= 0
    parts, sizes = np.unique(point_primitive[assigned], return_counts=True)
    if not len(parts):
        return Match(None, 0.0, 0.0)
    inside = point_primitive[assigned & truth]
    hits = np.array([(inside == part).sum() for part in parts])
    region = int(truth.sum())
    singles = hits / (region + sizes - hits)
    order = np.argsort(-hits / sizes, kind="stable")
    unions = hits[order].cumsum() / (region + (sizes - hits)[order].cumsum())
    best = int(singles.argmax())
    return Match(int(parts[best]), float(singles[best]), float(unions.max()))
