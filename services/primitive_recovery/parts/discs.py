"""Kernels that fill a picture's body with discs: what they leave sticks out of it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.parts.components import labelled
from services.primitive_recovery.parts.grid import grown
from shared.jit import kernel

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@kernel
def opened(distance: Array, radius: float) -> Mask:
    """Return the body (H, W): what discs of a radius cover, those linked to the largest.

    Parameters
    ----------
    distance : (H, W) array
        Of the object's cells from the background, in cells.
    radius : float
        In cells.
    """
    core = distance > radius
    numbers, sizes = labelled(core)
    if len(sizes) > 2:
        largest = 1 + np.argmax(sizes[1:])
        core = numbers == largest
    return within_reach(core, radius + 0.5)


@kernel
def within_reach(core: Mask, radius: float) -> Mask:
    """Return the cells (H, W) at most a radius, in cells, from one of the core (H, W).

    A cell of the core so far above or below reaches the same number of cells to both sides in
    a row, so every row is a sum of intervals.
    """
    rows, columns = core.shape
    tallest = int(radius)
    aside = np.zeros(tallest + 1, dtype=np.int64)
    for up in range(tallest + 1):
        while np.sqrt(float((aside[up] + 1) ** 2 + up * up)) <= radius:
            aside[up] += 1
    away = np.empty((rows, columns), dtype=np.int64)
    for j in range(columns):
        run = rows + columns
        for i in range(rows):
            run = 0 if core[i, j] else run + 1
            away[i, j] = run
        run = rows + columns
        for i in range(rows - 1, -1, -1):
            run = 0 if core[i, j] else run + 1
            away[i, j] = min(away[i, j], run)
    found = np.zeros((rows, columns), dtype=np.bool_)
    change = np.empty(columns + 1, dtype=np.int64)
    for i in range(rows):
        change[:] = 0
        for j in range(columns):
            if away[i, j] <= tallest:
                reach = aside[away[i, j]]
                change[max(j - reach, 0)] += 1
                change[min(j + reach + 1, columns)] -= 1
        covered = 0
        for j in range(columns):
            covered += change[j]
            found[i, j] = covered > 0
    return found


@kernel
def without_slivers(left: Mask, mask: Mask, seam: int) -> Mask:
    """Return the cells of a mask (H, W) left over without the seams along its body.

    Parameters
    ----------
    left, mask : (H, W) bool array
    seam : int
        How wide a seam is, in cells.
    """
    core = left & ~grown(mask & ~left, seam)
    return left & grown(core, seam + 1)
