"""A depth image as a picture: the object cut out, shaded, coloured point by point."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MARGIN = 0.10
TABLE, NO_PART = (0.93, 0.92, 0.90), (0.62, 0.62, 0.62)


def shade(depth: Array, focal: float) -> Array:
    """Return brightness (H, W) in [0, 1] of a depth image in metres, lit from the camera."""
    filled = np.where(depth > 0, depth, np.nan)
    down, right = np.gradient(filled)
    pixel = filled / focal
    with np.errstate(invalid="ignore"):
        facing = 1 / np.sqrt(1 + (down / pixel) ** 2 + (right / pixel) ** 2)
    return np.asarray(np.clip(np.nan_to_num(facing, nan=0.35), 0.25, 1.0))


def cut_out(mask: NDArray[np.bool_]) -> tuple[slice, slice]:
    """Return rows and columns of the square around a mask (H, W), as large as the image allows."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    side = int((1 + 2 * MARGIN) * max(np.ptp(rows), np.ptp(columns))) + 8
    side = min(side, *mask.shape)
    found = []
    for hit, length in zip((rows, columns), mask.shape, strict=True):
        start = int(np.clip((hit[0] + hit[-1] - side) // 2, 0, length - side))
        found.append(slice(start, start + side))
    return found[0], found[1]


def coloured(
    depth: Array, focal: float, on_object: NDArray[np.bool_], colours: Array, size: int
) -> Array:
    """Return a picture (size, size, 4) of the object with a colour (H, W, 3) per pixel."""
    light = shade(depth, focal)[..., None]
    picture = np.where(on_object[..., None], colours * (0.30 + 0.70 * light), TABLE)
    rows, columns = cut_out(on_object)
    crop = picture[rows, columns]
    index = (np.arange(size) + 0.5) * len(crop) / size - 0.5
    low = np.clip(np.floor(index).astype(int), 0, len(crop) - 2)
    share = np.clip(index - low, 0, 1)
    mixed = crop[low] * (1 - share)[:, None, None] + crop[low + 1] * share[:, None, None]
    mixed = mixed[:, low] * (1 - share)[:, None] + mixed[:, low + 1] * share[:, None]
    return np.dstack([mixed, np.ones(mixed.shape[:2])])
