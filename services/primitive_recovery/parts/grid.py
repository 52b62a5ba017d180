"""Kernels on pictures of cells."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel
from shared.sorting import middle

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@kernel
def distance_to_unset(mask: Mask) -> Array:
    """Return every cell's distance (H, W) to the nearest unset one, in cells.

    Nothing lies beyond the picture; where no cell is unset, all are far.
    """
    return distances_at(mask, mask)


@kernel
def distances_at(wanted: Mask, mask: Mask) -> Array:
    """Return the distance (H, W) of rows with wanted cells to the nearest unset cell of a mask.

    0 in other rows. Felzenszwalb and Huttenlocher: Distance Transforms of Sampled Functions,
    2012: exact, in time linear in the cells.
    """
    rows, columns = mask.shape
    far = float(rows + columns)
    squared = np.zeros((rows, columns))
    for j in range(columns):
        run = far
        for i in range(rows):
            run = run + 1.0 if mask[i, j] else 0.0
            squared[i, j] = run
        run = far
        for i in range(rows - 1, -1, -1):
            run = run + 1.0 if mask[i, j] else 0.0
            least = min(run, squared[i, j])
            squared[i, j] = least * least
    found = np.zeros((rows, columns))
    place = np.zeros(columns, dtype=np.int64)
    border = np.zeros(columns + 1)
    for i in range(rows):
        if not wanted[i].any():
            continue
        level = squared[i]
        count = 0  # parabolas of the lower envelope so far, less one
        place[0], border[0], border[1] = 0, -np.inf, np.inf
        for j in range(1, columns):
            while True:
                k = place[count]
                meet = (level[j] + j * j - level[k] - k * k) / (2.0 * (j - k))
                if meet > border[count]:
                    break
                count -= 1
            count += 1
            place[count], border[count], border[count + 1] = j, meet, np.inf
        count = 0
        for j in range(columns):
            while border[count + 1] < j:
                count += 1
            gap = j - place[count]
            found[i, j] = np.sqrt(gap * gap + level[place[count]])
    return found


@kernel
def solidity(mask: Mask) -> float:
    """Return the share of its convex hull that a mask covers; corners of cells count."""
    rows, columns = mask.shape
    left = np.empty((2 * rows, 2))
    right = np.empty((2 * rows, 2))
    kept = np.zeros(2, dtype=np.int64)
    area = 0
    for i in range(rows):
        first, last = columns, -1
        for j in range(columns):
            if mask[i, j]:
                area += 1
                first = min(first, j)
                last = j
        if last < 0:
            continue
        for y in (i, i + 1):
            _extend(left, kept, 0, float(y), float(first), 1.0)
            _extend(right, kept, 1, float(y), float(last + 1), -1.0)
    if area == 0:
        return 1.0
    twice = 0.0
    for chain, count, sign in ((left, kept[0], -1.0), (right, kept[1], 1.0)):
        for k in range(count - 1):
            (y, x), (to_y, to_x) = chain[k], chain[k + 1]
            twice += sign * (to_y - y) * (x + to_x)
    return 2.0 * area / twice


@kernel
def _extend(
    chain: Array, kept: NDArray[np.int64], which: int, y: float, x: float, sign: float
) -> None:
    """Append a corner to one side of the hull, dropping those that it makes concave."""
    count = kept[which]
    if count and chain[count - 1, 0] == y:
        if sign * (x - chain[count - 1, 1]) >= 0:
            return
        count -= 1
    while count > 1:
        ay, ax = chain[count - 2]
        by, bx = chain[count - 1]
        turn = (by - ay) * (x - ax) - (bx - ax) * (y - ay)
        if sign * turn > 0:
            break
        count -= 1
    chain[count, 0], chain[count, 1] = y, x
    kept[which] = count + 1


@kernel
def branch_sums(
    branch: Mask, rest: Mask, holes: NDArray[np.int32], count: int, near: Array, tall: Array
) -> tuple[Array, NDArray[np.bool_]]:
    """Return sums over a branch's cells, over the rest's and over their border.

    Parameters
    ----------
    branch, rest : (H, W) bool array
        Cells; both are empty along the picture's border.
    holes : (H, W) int32 array
        Number of the hole that a cell belongs to, from 1; 0 for none.
    count : int
        How many there are.
    near, tall : (H, W) array
        Nearness and height of the cells.

    Returns
    -------
    sums : (3, 12) array
        Rows: branch, rest, border cells of the branch. Columns: cells, rows,
        columns, rows^2, rows columns, columns^2, nearness, least and greatest
        nearness, height, least and greatest height. Where the border has cells
        of the rest, their mean nearness is in the last row's column 7.
    touched : (count + 1,) bool array
        Holes that the branch has a border with.
    """
    rows, columns = branch.shape
    sums = np.zeros((3, 12))
    sums[:, 7] = sums[:, 10] = np.inf
    sums[:, 8] = sums[:, 11] = -np.inf
    touched = np.zeros(count + 1, dtype=np.bool_)
    facing, facing_near = 0, 0.0
    for i in range(1, rows - 1):
        for j in range(1, columns - 1):
            if not (branch[i, j] or rest[i, j]):
                continue
            here = branch[i, j]
            border = False
            for y in range(i - 1, i + 2):
                for x in range(j - 1, j + 2):
                    if here and rest[y, x]:
                        border = True
                    if not here and branch[y, x]:
                        border = True
                    if here and holes[y, x] > 0:
                        touched[holes[y, x]] = True
            _add(sums, 0 if here else 1, i, j, near[i, j], tall[i, j])
            if border and here:
                _add(sums, 2, i, j, near[i, j], tall[i, j])
            elif border:
                facing += 1
                facing_near += near[i, j]
    sums[2, 7] = facing_near / facing if facing else 0.0
    return sums, touched


@kernel
def _add(sums: Array, row: int, i: int, j: int, near: float, tall: float) -> None:
    sums[row, 0] += 1
    sums[row, 1] += i
    sums[row, 2] += j
    sums[row, 3] += i * i
    sums[row, 4] += i * j
    sums[row, 5] += j * j
    sums[row, 6] += near
    sums[row, 7] = min(sums[row, 7], near)
    sums[row, 8] = max(sums[row, 8], near)
    sums[row, 9] += tall
    sums[row, 10] = min(sums[row, 10], tall)
    sums[row, 11] = max(sums[row, 11], tall)


@kernel
def grown(mask: Mask, times: int) -> Mask:
    """Return the mask with its neighbours, straight and diagonal, added `times` times."""
    rows, columns = mask.shape
    held = mask
    for _ in range(times):
        along = held.copy()
        for i in range(rows):
            for j in range(columns):
                if held[i, j]:
                    along[i, max(j - 1, 0)] = True
                    along[i, min(j + 1, columns - 1)] = True
        both = along.copy()
        for i in range(rows):
            for j in range(columns):
                if along[i, j]:
                    both[max(i - 1, 0), j] = True
                    both[min(i + 1, rows - 1), j] = True
        held = both
    return held


@kernel
def cell_means(
    mask: Mask, row: NDArray[np.int64], column: NDArray[np.int64], values: Array
) -> Array:
    """Return the mean value (H, W) of each cell's points.

    Cells of the mask without points take the mean of their neighbours, or of all.

    Parameters
    ----------
    mask : (H, W) bool array
        Cells that get a value; empty along the picture's border.
    row, column : (N,) array
        Cell of each point.
    values : (N,) array
        Value of each point.
    """
    rows, columns = mask.shape
    total, number = np.zeros((rows, columns)), np.zeros((rows, columns))
    for k in range(len(values)):
        total[row[k], column[k]] += values[k]
        number[row[k], column[k]] += 1
    overall = values.sum() / max(len(values), 1)
    found = np.zeros((rows, columns))
    for i in range(rows):
        for j in range(columns):
            if number[i, j] > 0:
                found[i, j] = total[i, j] / number[i, j]
            elif mask[i, j]:
                held, around = 0.0, 0
                for y in range(i - 1, i + 2):
                    for x in range(j - 1, j + 2):
                        if number[y, x] > 0:
                            held += total[y, x] / number[y, x]
                            around += 1
                found[i, j] = held / around if around else overall
    return found


@kernel
def unevenness(values: Array, mask: Mask) -> float:
    """Return how far neighbours (H, W) of a mask differ beyond a slope: noise, per cell.

    The median second difference along the rows, as the deviation of a normal distribution.
    """
    rows, columns = mask.shape
    found = np.empty(rows * columns)
    count = 0
    for i in range(rows):
        for j in range(1, columns - 1):
            if mask[i, j - 1] and mask[i, j] and mask[i, j + 1]:
                found[count] = abs(values[i, j + 1] - 2 * values[i, j] + values[i, j - 1])
                count += 1
    return middle(found[:count]) / 1.65 if count > 0 else 0.0


_LINES = np.array([[0, 1], [1, 0], [1, 1], [1, -1], [1, 2], [2, 1], [1, -2], [2, -1]])


@kernel
def bridged(mask: Mask, hidden: Mask, depth: Array) -> Array:
    """Return the depth (H, W) of hidden cells on straight lines between cells of a mask.

    Along eight lines a cell looks both ways through hidden cells alone; where both looks end
    at the mask, the cell lies between them, and the shortest such line gives its depth. 0
    for all other cells.

    Parameters
    ----------
    mask, hidden : (H, W) bool array
        Without common cells.
    depth : (H, W) array
        Of the mask's cells, all greater than 0.
    """
    rows, columns = mask.shape
    found = np.zeros((rows, columns))
    for i in range(rows):
        for j in range(columns):
            if not hidden[i, j]:
                continue
            shortest = np.inf
            for line in range(_LINES.shape[0]):
                dy, dx = _LINES[line]
                step = np.sqrt(dy * dy + dx * dx)
                ahead, to_ahead = _look(mask, hidden, depth, i, j, dy, dx)
                if ahead <= 0.0:
                    continue
                back, to_back = _look(mask, hidden, depth, i, j, -dy, -dx)
                length = (to_ahead + to_back) * step
                if back > 0.0 and length < shortest:
                    shortest = length
                    found[i, j] = (ahead * to_back + back * to_ahead) / (to_ahead + to_back)
    return found


@kernel
def _look(
    mask: Mask, hidden: Mask, depth: Array, i: int, j: int, dy: int, dx: int
) -> tuple[float, int]:
    """Return the depth of the first cell of the mask along a line, 0 for none, and the steps."""
    steps = 1
    y, x = i + dy, j + dx
    while 0 <= y < mask.shape[0] and 0 <= x < mask.shape[1]:
        if mask[y, x]:
            return depth[y, x], steps
        if not hidden[y, x]:
            break
        steps += 1
        y += dy
        x += dx
    return 0.0, steps


@kernel
def nearest_of(
    mask: Mask, cells: NDArray[np.int64], reach: NDArray[np.int64], depth: Array
) -> Array:
    """Return the least depth (H, W) of the squares about points, infinite where there is none.

    Parameters
    ----------
    mask : (H, W) bool array
        Of the picture's size.
    cells : (M, 2) array
        Row and column of each point, also outside of the picture.
    reach : (M,) array
        Half side of its square, cells.
    depth : (M,) array
    """
    rows, columns = mask.shape
    found = np.full((rows, columns), np.inf)
    for k in range(len(depth)):
        row, column, r = cells[k, 0], cells[k, 1], reach[k]
        for i in range(max(row - r, 0), min(row + r + 1, rows)):
            for j in range(max(column - r, 0), min(column + r + 1, columns)):
                found[i, j] = min(found[i, j], depth[k])
    return found
