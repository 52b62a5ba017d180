"""Kernels of the relief: heights gathered in a grid over the plane, and what they tell.

Grids have a rim one cell wide that no point falls into, so that every cell within it
has eight neighbours. Cells are numbered row by row; cell 0, on the rim, stands for none.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.perception.interpolation import value_at
from shared.jit import kernel

Array = NDArray[np.float64]
Cells = NDArray[np.int32]
Mask = NDArray[np.bool_]


@kernel
def survey(
    points: Array,
    plane: tuple[Array, float],
    viewpoint: Array,
    noise: tuple[Array, Array],
    limits: tuple[float, float, float],
    axes: Array,
    origin: Array,
    rows: int,
    columns: int,
) -> tuple[Cells, Array, Mask, Mask]:
    """Sum up the heights of points (N, 3) above a plane over each cell, and sort them out.

    In one pass, and a height's deviation is only made out where it matters: most points of a
    view lie so close to its support that no noise is asked for.

    Parameters
    ----------
    plane : tuple
        Normal (3,) and offset.
    viewpoint : (3,) array
        Position of the sensor.
    noise : tuple of array
        Ranges (B,) and the standard deviations (B,) of heights there.
    limits : tuple of float
        The least height of relief, one that leaves no doubt, and how far the plane reaches.
        What lies lower than the first and three deviations below the plane is left out of the
        sums; no height counts for more than the second or eight deviations.
    axes : (2, 3) array
        Directions of the grid's rows and columns, divided by the edge of a cell.
    origin : (2,) array
        Where the first cell within the rim begins, along them.

    Returns
    -------
    cells : (N,) array
        `row * columns + column`, 0 for none.
    sums : (rows, columns, 2) array
        Number of points and sum of heights.
    above : (N,) array of bool
        What is higher than the second limit and eight deviations.
    close : (N,) array of bool
        What is, on either side, within the third limit or four deviations.
    """
    normal, offset = plane
    a, b, c = normal[0], normal[1], normal[2]
    low, tall, near = limits
    floor = 0.9 * noise[1].min()  # no deviation is as small, by whatever rounding
    sunk = -3.0 * floor - low
    ua, ub, uc, u0 = axes[0, 0], axes[0, 1], axes[0, 2], origin[0]
    va, vb, vc, v0 = axes[1, 0], axes[1, 1], axes[1, 2], origin[1]
    cells = np.zeros(len(points), dtype=np.int32)
    sums = np.zeros((rows * columns, 2))
    above, close = np.empty(len(points), dtype=np.bool_), np.empty(len(points), dtype=np.bool_)
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        height = a * x + b * y + c * z + offset
        sigma = floor
        if height <= sunk or height > tall or abs(height) >= near:
            dx, dy, dz = x - viewpoint[0], y - viewpoint[1], z - viewpoint[2]
            sigma = value_at(np.sqrt(dx * dx + dy * dy + dz * dz), noise[0], noise[1])
        most = max(tall, 8.0 * sigma)
        above[i] = height > most
        close[i] = abs(height) < max(near, 4.0 * sigma)
        if not height > -3.0 * sigma - low:
            continue
        u = ua * x + ub * y + uc * z - u0
        v = va * x + vb * y + vc * z - v0
        if not (0.0 <= u < rows - 2 and 0.0 <= v < columns - 2):
            continue
        cell = np.uint32((int(u) + 1) * columns + int(v) + 1)
        sums[cell, 0] += 1.0
        sums[cell, 1] += min(height, most)
        cells[i] = cell
    return cells, sums.reshape(rows, columns, 2), above, close


@kernel
def window_means(sums: Array) -> tuple[Array, Array]:
    """Return number of points and mean height (R, C) of the 3x3 window of each cell.

    Zero on the rim; the mean is zero where there is no point.
    """
    rows, columns = sums.shape[:2]
    count, mean = np.zeros((rows, columns)), np.zeros((rows, columns))
    number, total = np.empty(columns), np.empty(columns)
    for i in range(1, rows - 1):
        for j in range(columns):
            number[j] = sums[i - 1, j, 0] + sums[i, j, 0] + sums[i + 1, j, 0]
            total[j] = sums[i - 1, j, 1] + sums[i, j, 1] + sums[i + 1, j, 1]
        for j in range(1, columns - 1):
            points = number[j - 1] + number[j] + number[j + 1]
            count[i, j] = points
            mean[i, j] = (total[j - 1] + total[j] + total[j + 1]) / max(points, 1.0)
    return count, mean


@kernel
def grow(sure: Mask, weak: Mask) -> Mask:
    """Return the weak cells (R, C) that hang together, also by corners, with a sure one.

    Sure cells are weak ones; on the rim there are none.
    """
    rows, columns = weak.shape
    kept = np.zeros(weak.shape, dtype=np.bool_)
    stack = np.empty(rows * columns, dtype=np.int32)
    for i in range(1, rows - 1):
        for j in range(1, columns - 1):
            if not sure[i, j] or kept[i, j]:
                continue
            kept[i, j] = True
            stack[0] = i * columns + j
            waiting = 1
            while waiting > 0:
                waiting -= 1
                row, column = stack[waiting] // columns, stack[waiting] % columns
                for r in range(row - 1, row + 2):
                    for c in range(column - 1, column + 2):
                        if weak[r, c] and not kept[r, c]:
                            kept[r, c] = True
                            stack[waiting] = r * columns + c
                            waiting += 1
    return kept


@kernel
def highest_around(cells: Cells, mean: Array, kept: Mask) -> Array:
    """Return the largest kept mean in the 3x3 windows of `cells` (K,), none of them on the rim."""
    columns = mean.shape[1]
    top = np.zeros(len(cells))
    for k in range(len(cells)):
        row, column = cells[k] // columns, cells[k] % columns
        for r in range(row - 1, row + 2):
            for c in range(column - 1, column + 2):
                if kept[r, c] and mean[r, c] > top[k]:
                    top[k] = mean[r, c]
    return top


@kernel
def points_over(cells: Cells, kept: Mask) -> NDArray[np.intp]:
    """Return the points, by row of `cells` (N,), that stand over a kept cell."""
    over = kept.ravel()
    rows = np.empty(len(cells), dtype=np.intp)
    count = 0
    for i in range(len(cells)):
        if over[np.uint32(cells[i])]:
            rows[count] = i
            count += 1
    return rows[:count]
