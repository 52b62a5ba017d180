"""What sticks out of an object's body: side handles, whichever way they point."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.parts.branch_features import ENCLOSES, branch_features
from services.primitive_recovery.parts.components import labelled, much_the_same
from services.primitive_recovery.parts.discs import opened, without_slivers
from services.primitive_recovery.parts.grid import (
    cell_means,
    distance_to_unset,
    grown,
    solidity,
    unevenness,
)
from services.primitive_recovery.parts.openings import holes_of
from services.primitive_recovery.parts.ridges import standing_out
from services.primitive_recovery.parts.silhouette import Mask
from services.primitive_recovery.parts.view import PartView

Array = NDArray[np.float64]

RADII = (0.3, 0.45, 0.6, 0.75, 0.88)
"""Of the discs that must fit into the body, as shares of the largest disc that does."""

LEAST_SHARE = 0.03
"""Of the silhouette's area: less is a rounded corner."""

RAW = (0.5, 0.8)
"""The same, for the silhouette with all its gaps: lost pixels, or background behind a handle."""

WINDOWS = (0.4,)
"""Half sides of the windows that tell what stands out in depth, as shares of that disc."""

STEP = 0.22
"""How far it must, in radii of that disc."""

PIECE_RADII = (0.45, 0.75)
"""RADII of a part that was cut from an object already, where little sticks out."""

BESIDE = 0.7
"""Of RADII, the one that finds the rest of it, beside the body."""

CONVEX = 0.96
"""Share of its convex hull that a silhouette fills from which nothing sticks out."""

MOST = 2
"""Branches looked at per radius, largest first."""

SEAM = 1
"""Cells along the body that discs leave of its rim."""

SAME = 0.97
"""Share of the cells of two branches that both have, if they are one."""


@dataclass(frozen=True)
class Branch:
    """A candidate: the cells of a branch, and what speaks for it.

    Attributes
    ----------
    cells : (H, W) bool array
        Part of the silhouette's (closed) mask.
    features : (F,) array
        Free of scale and of the picture's rotation.
    encloses : bool
        Whether background shows between it and the body.
    """

    cells: Mask
    features: Array
    encloses: bool


def branches(view: PartView) -> list[Branch]:
    """Return what is left of the silhouette when discs of several radii have filled its body.

    Parameters
    ----------
    view : PartView
        Of the object.
    """
    picture = view.picture
    mask = picture.closed
    distance = distance_to_unset(mask)
    widest = float(distance.max())
    area = int(mask.sum())
    size = float(np.sqrt(area))
    found: list[Branch] = []
    whole = solidity(mask)
    if widest < 2 or whole > CONVEX:
        return found
    metres = picture.cell * size
    near = cell_means(mask, picture.row, picture.column, view.nearness / metres)
    tall = cell_means(mask, picture.row, picture.column, view.height / metres)
    holes = holes_of(mask, view.hidden.mask)
    hole_sizes = np.bincount(holes.ravel())
    seen: list[Mask] = []
    for kind, share, left in _left_over(view, mask, distance, near):
        numbers, sizes = labelled(without_slivers(left, mask, SEAM))
        for number in 1 + np.argsort(-sizes[1:], kind="stable")[:MOST]:
            if sizes[number] < LEAST_SHARE * area:
                break
            cells = np.asarray(numbers == number)
            if 2 * sizes[number] > area:
                cells = mask & ~cells
                if cells.sum() < LEAST_SHARE * area:
                    continue
            if any(much_the_same(cells, other, SAME) for other in seen):
                continue
            seen.append(cells)
            row = branch_features(mask, cells, distance, holes, hole_sizes, near, tall)
            about = [share, float(kind == "depth"), float(view.is_piece), whole]
            # Discs end a cell short of the concave corner where a branch leaves the body.
            reach = mask & grown(cells, 1)
            found.append(Branch(reach, np.concatenate([about, row]), bool(row[ENCLOSES] > 0)))
    return found


def _left_over(
    view: PartView, mask: Mask, distance: Array, near: Array
) -> Iterator[tuple[str, float, Mask]]:
    """Yield each kind of body with its share, and the cells (H, W) of the object beside it."""
    widest = float(distance.max())
    for share in PIECE_RADII if view.is_piece else RADII:
        yield "closed", share, mask & ~opened(distance, share * widest)
    if view.is_piece:
        return
    raw = distance_to_unset(view.picture.mask)
    for share in RAW:
        yield "raw", share, mask & ~opened(raw, share * float(raw.max()))
    size = float(np.sqrt(mask.sum()))
    least = max(STEP * widest / size, 5 * unevenness(near, mask))
    beside = ~opened(distance, BESIDE * widest)
    for share in WINDOWS:
        out = standing_out(near, mask, max(round(share * widest), 2), least) > least
        yield "depth", share, mask & (out | beside)
