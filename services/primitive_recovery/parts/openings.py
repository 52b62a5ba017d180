"""Holes through a part: topology of the silhouette."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.parts.components import enclosed, labelled_by_sides
from services.primitive_recovery.parts.grid import distance_to_unset, grown
from services.primitive_recovery.parts.silhouette import Silhouette

Array = NDArray[np.float64]

LEAST_SHARE = 0.02
"""Of the part's outline that an opening must have."""
LEAST_RADIUS = 2.0
"""Cells: narrower gaps are lost pixels."""


def count_holes(
    picture: Silhouette,
    labels: NDArray[np.int16],
    hidden: NDArray[np.bool_] | None = None,
    seen: int | None = None,
) -> tuple[int, ...]:
    """Return for every part how many openings the sensor saw the background through.

    An opening is enclosed by the part alone; what two parts enclose together
    (a mug's body and its handle) belongs to the one that goes round most of it.

    Parameters
    ----------
    picture : Silhouette
        Of the whole object.
    labels : (N,) int16 array
        Part of every point, from 0.
    hidden : (H, W) bool array, optional
        Cells where something else is in front: no background was seen there.
    seen : int, optional
        How many of the points, the first ones, the sensor saw; the others bridge what is
        hidden. Openings that only such bridges part are one.
    """
    count = int(labels.max()) + 1
    holes = [0] * count
    gaps = holes_of(picture.closed, hidden)
    if not gaps.any():
        return tuple(holes)
    if hidden is not None and seen is not None and seen < len(labels):
        visible = np.zeros_like(picture.mask)
        visible[picture.row[:seen], picture.column[:seen]] = True
        joined, _ = labelled_by_sides((gaps > 0) | hidden | (picture.mask & ~visible))
        gaps = np.where(gaps > 0, joined, 0)
    part = np.full(gaps.shape, -1, dtype=np.int16)
    part[picture.row, picture.column] = labels
    radius = distance_to_unset(gaps > 0)
    for index in np.unique(gaps[gaps > 0]):
        gap = gaps == index
        around = part[grown(gap, 2) & ~gap]
        votes = np.bincount(around[around >= 0], minlength=count)
        owner = int(votes.argmax())
        outline = float((part == owner).sum() + gap.sum())
        if radius[gap].max() >= LEAST_RADIUS and gap.sum() >= LEAST_SHARE * outline:
            holes[owner] += 1
    return tuple(holes)


def holes_of(mask: NDArray[np.bool_], hidden: NDArray[np.bool_] | None = None) -> NDArray[np.int32]:
    """Return the number of the hole (H, W) that each cell belongs to, from 1; 0 for none.

    A hole is background that no path to the picture's border leaves; cells that
    touch at a corner alone are apart, as those of the mask hang together there.
    Hidden cells (H, W) are paths, as the object may be absent there, but no hole.
    """
    return enclosed(mask, np.zeros_like(mask) if hidden is None else hidden)
