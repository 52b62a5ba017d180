"""What sticks out of an object's body: side handles, whichever way they point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from services.primitive_recovery.parts.grid import (
    branch_sums,
    distance_to_unset,
    grown,
    solidity,
)
from services.primitive_recovery.parts.openings import holes_of
from services.primitive_recovery.parts.ridges import standing_out
from services.primitive_recovery.parts.silhouette import Silhouette
from services.primitive_recovery.parts.view import PartView
from shared.geometry.rotation import unit

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

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
    """

    cells: Mask
    features: Array


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
    near = _filled_picture(picture, view.nearness / metres, mask)
    tall = _filled_picture(picture, view.height / metres, mask)
    holes = holes_of(mask)
    seen: list[Mask] = []
    noise = _unevenness(near, mask)
    raw = distance_to_unset(picture.mask)
    tries = [("closed", s) for s in RADII] + [("raw", s) for s in RAW] + [("depth", s) for s in WINDOWS]
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
            row = _features(mask, cells, distance, holes, near, tall)
            found.append(Branch(cells, np.array([share, float(kind == "depth"), float(view.is_piece), whole, *row])))
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


def _features(
    mask: Mask,
    cells: Mask,
    distance: Array,
    holes: NDArray[np.int32],
    near: Array,
    tall: Array,
) -> list[float]:
    rest = mask & ~cells
    hole_sizes = np.bincount(holes.ravel())
    sums, touched = branch_sums(cells, rest, holes, len(hole_sizes) - 1, near, tall)
    area = float(sums[0, 0] + sums[1, 0])
    size = float(np.sqrt(area))
    contact = float(sums[2, 0])
    away = distance_to_unset(~rest)[cells]
    thick, bulk = float(distance[cells].max()), float(distance[rest].max(initial=1.0))
    between = float(hole_sizes[touched].sum()) if len(hole_sizes) > 1 else 0.0
    long_, short, axis, centre = _spread(sums[0])
    body_long, body_short, body_axis, body_centre = _spread(sums[1])
    root = sums[2, 1:3] / contact if contact else centre
    outward, radial = unit(centre - root), unit(centre - body_centre)
    step = float(sums[2, 6] / contact - sums[2, 7]) if contact else 0.0
    return [
        sums[0, 0] / area,
        contact / size,
        contact / (2 * thick),
        contact / float(np.sqrt(sums[0, 0])),
        thick / bulk,
        thick / size,
        float(away.max()) / size,
        float(away.max()) / (2 * thick),
        float(away.mean()) / size,
        solidity(rest),
        solidity(cells),
        float(hole_sizes[1:].sum()) / area,
        between / area,
        float(between > 0),
        long_ / size,
        short / size,
        body_long / size,
        body_short / size,
        abs(float(axis @ outward)),
        abs(float(radial @ outward)),
        abs(float(axis @ radial)),
        abs(float(body_axis @ radial)),
        step,
        float(sums[0, 6] / sums[0, 0] - sums[1, 6] / sums[1, 0]),
        float(sums[0, 8] - sums[0, 7]),
        float(sums[0, 9] / sums[0, 0]),
        float(sums[0, 11]),
        float(sums[0, 10]),
        float(sums[1, 9] / sums[1, 0]),
        float(sums[1, 11]),
        float(sums[1, 10]),
    ]


def _filled_picture(picture: Silhouette, values: Array, mask: Mask) -> Array:
    """Return the mean value (H, W) of each cell's points; closed cells take their neighbours'."""
    shape = mask.shape
    flat = picture.row * shape[1] + picture.column
    number = np.bincount(flat, minlength=mask.size).reshape(shape)
    total = np.bincount(flat, values, minlength=mask.size).reshape(shape)
    image = total / np.maximum(number, 1)
    known = number > 0
    for i, j in np.argwhere(mask & ~known):
        window = slice(i - 1, i + 2), slice(j - 1, j + 2)
        around = known[window]
        if around.any():
            image[i, j] = image[window][around].mean()
        else:
            image[i, j] = image[known].mean()
    return np.asarray(image)


def _spread(sums: Array) -> tuple[float, float, Array, Array]:
    """Return standard deviations along the principal axes, the longer axis, and the middle."""
    n = max(float(sums[0]), 1.0)
    y, x = sums[1] / n, sums[2] / n
    covariance = np.array(
        [[sums[3] / n - y * y, sums[4] / n - x * y], [sums[4] / n - x * y, sums[5] / n - x * x]]
    )
    values, vectors = np.linalg.eigh(covariance)
    deviations = np.sqrt(np.maximum(values, 0.08))
    return float(deviations[1]), float(deviations[0]), vectors[:, 1], np.array([y, x])
