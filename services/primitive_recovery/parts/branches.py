"""What sticks out of an object's body: side handles, whichever way they point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from services.primitive_recovery.parts.branch_features import ENCLOSES, branch_features
from services.primitive_recovery.parts.grid import (
    cell_means,
    distance_to_unset,
    grown,
    solidity,
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

TRIES = (
    *(("closed", share) for share in RADII),
    *(("raw", share) for share in RAW),
    *(("depth", share) for share in WINDOWS),
)
PIECE_TRIES = (("closed", 0.45), ("closed", 0.75))
"""Of a part that was cut from an object already, where little sticks out."""

BESIDE = 0.7
"""Of RADII, the one that finds the rest of it, beside the body."""

CONVEX = 0.96
"""Share of its convex hull that a silhouette fills from which nothing sticks out."""

MOST = 2
"""Branches looked at per radius, largest first."""

_ROUND = np.ones((3, 3), dtype=bool)


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
    seen: list[Mask] = []
    noise = _unevenness(near, mask)
    raw = distance_to_unset(picture.mask)
    hole_sizes = np.bincount(holes.ravel())
    tries = PIECE_TRIES if view.is_piece else TRIES
    for kind, share in tries:
        if kind == "depth":
            least = max(STEP * widest / size, 5 * noise)
            left = standing_out(near, mask, max(round(share * widest), 2), least) > least
            left = mask & (left | ~_opened(distance, BESIDE * widest))
        elif kind == "raw":
            left = mask & ~_opened(raw, share * float(raw.max()))
        else:
            left = mask & ~_opened(distance, share * widest)
        rest, count = ndimage.label(_without_slivers(left, mask), structure=_ROUND)
        if count == 0:
            continue
        sizes = np.bincount(rest.ravel(), minlength=count + 1)[1:]
        for index in np.argsort(-sizes, kind="stable")[:MOST]:
            if sizes[index] < LEAST_SHARE * area:
                break
            cells = np.asarray(rest == index + 1)
            if 2 * sizes[index] > area:
                cells = mask & ~cells
                if cells.sum() < LEAST_SHARE * area:
                    continue
            if any((cells & other).sum() > 0.97 * (cells | other).sum() for other in seen):
                continue
            seen.append(cells)
            row = branch_features(mask, cells, distance, holes, hole_sizes, near, tall)
            about = [share, float(kind == "depth"), float(view.is_piece), whole]
            # Discs end a cell short of the concave corner where a branch leaves the body.
            reach = mask & grown(cells, 1)
            found.append(Branch(reach, np.concatenate([about, row]), bool(row[ENCLOSES] > 0)))
    return found


def _opened(distance: Array, radius: float) -> Mask:
    """Return the body: what discs of this radius cover, those linked to the largest."""
    core, count = ndimage.label(distance > radius, structure=_ROUND)
    if count > 1:
        sizes = np.bincount(core.ravel())
        sizes[0] = 0
        core = core == int(sizes.argmax())
    return np.asarray(distance_to_unset(core == 0) <= radius + 0.5)


def _without_slivers(left: Mask, mask: Mask) -> Mask:
    """Return the cells left over without the seams, one cell wide, along the body."""
    body = mask & ~left
    core = left & ~grown(body, 1)
    return np.asarray(left & grown(core, 2))


def _unevenness(near: Array, mask: Mask) -> float:
    """Return how far neighbours differ beyond a slope: the sensor's noise, per cell."""
    second = near[:, 2:] - 2 * near[:, 1:-1] + near[:, :-2]
    inside = mask[:, 2:] & mask[:, 1:-1] & mask[:, :-2]
    return float(np.median(np.abs(second[inside])) / 1.65) if inside.any() else 0.0
