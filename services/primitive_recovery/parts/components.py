"""Kernels on what hangs together in a picture of cells."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Mask = NDArray[np.bool_]
Numbers = NDArray[np.int32]
Sizes = NDArray[np.int64]


@kernel
def labelled(mask: Mask) -> tuple[Numbers, Sizes]:
    """Return the component that each set cell belongs to, and the cells of each.

    Parameters
    ----------
    mask : (H, W) bool array
        Cells that touch at a corner alone hang together.

    Returns
    -------
    numbers : (H, W) int32 array
        From 1, in the order of the components' first cells, row by row; 0 for unset cells.
    sizes : (components + 1,) array
        The first is that of the unset cells.
    """
    return _labelled(mask, True)


@kernel
def labelled_by_sides(mask: Mask) -> tuple[Numbers, Sizes]:
    """Return the same as `labelled`; cells that touch at a corner alone are apart."""
    return _labelled(mask, False)


@kernel
def _labelled(mask: Mask, corners: bool) -> tuple[Numbers, Sizes]:
    """Label in two passes with a forest of equivalent labels (Rosenfeld and Pfaltz 1966)."""
    rows, columns = mask.shape
    numbers = np.zeros((rows, columns), dtype=np.int32)
    parent = np.zeros(rows * columns // 2 + 2, dtype=np.int32)
    count = 0
    for i in range(rows):
        for j in range(columns):
            if not mask[i, j]:
                continue
            own = numbers[i, j - 1] if j > 0 else 0
            if i > 0:
                first, last = (max(j - 1, 0), min(j + 2, columns)) if corners else (j, j + 1)
                for x in range(first, last):
                    above = numbers[i - 1, x]
                    if above > 0 and above != own:
                        own = _joined(parent, own, above) if own > 0 else above
            if own == 0:
                count += 1
                own = parent[count] = count
            numbers[i, j] = own
    found = 0
    for k in range(1, count + 1):  # no parent comes after its children
        if parent[k] == k:
            found += 1
            parent[k] = found
        else:
            parent[k] = parent[parent[k]]
    sizes = np.zeros(found + 1, dtype=np.int64)
    for i in range(rows):
        for j in range(columns):
            numbers[i, j] = parent[numbers[i, j]]
            sizes[numbers[i, j]] += 1
    return numbers, sizes


@kernel
def _joined(parent: Numbers, one: int, other: int) -> int:
    """Make two labels one, in place, and return their root."""
    while parent[one] != one:
        one = parent[one]
    while parent[other] != other:
        other = parent[other]
    if one > other:
        one, other = other, one
    parent[other] = one
    return one


@kernel
def enclosed(mask: Mask, hidden: Mask) -> Numbers:
    """Return the number (H, W) of the hole that each cell belongs to, as `holes_of` does."""
    rows, columns = mask.shape
    found, sizes = labelled_by_sides(~mask)
    inside = np.zeros(len(sizes), dtype=np.bool_)
    for i in range(rows):
        for j in range(columns):
            inside[found[i, j]] |= not hidden[i, j]
    for i in range(rows):
        inside[found[i, 0]] = inside[found[i, columns - 1]] = False
    for j in range(columns):
        inside[found[0, j]] = inside[found[rows - 1, j]] = False
    inside[0] = False
    number = np.cumsum(inside)
    for i in range(rows):
        for j in range(columns):
            kept = inside[found[i, j]] and not hidden[i, j]
            found[i, j] = number[found[i, j]] if kept else 0
    return found


@kernel
def much_the_same(one: Mask, other: Mask, share: float) -> bool:
    """Return whether two masks (H, W) have more than a share of their union in common."""
    common, either = 0, 0
    for i in range(one.shape[0]):
        for j in range(one.shape[1]):
            common += one[i, j] and other[i, j]
            either += one[i, j] or other[i, j]
    return common > share * either
