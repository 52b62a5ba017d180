"""What stands out towards the sensor: a handle in front of its mug."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

ROUNDS = 3
"""Of fitting and leaving out what stands out."""


@kernel
def standing_out(near: Array, mask: Mask, radius: int, least: float) -> Array:
    """Return how far each cell (H, W) stands out from the plane through its surroundings.

    The plane through the cells of a square window is fitted by least squares,
    then again without the cells that stand out from it. Windows are summed
    from tables of cumulative sums (Crow 1984).

    Parameters
    ----------
    near : (H, W) array
        Distance towards the sensor, in any unit.
    mask : (H, W) bool array
        Where it is known.
    radius : int
        Half the window's side, cells.
    least : float
        What stands out by more is left out of the next fit.
    """
    rows, columns = mask.shape
    excess = np.zeros((rows, columns))
    total = np.zeros((rows + 1, columns + 1, 9))
    row_sum, box = np.zeros(9), np.zeros(9)
    for _ in range(ROUNDS):
        for i in range(rows):
            row_sum[:] = 0.0
            for j in range(columns):
                if mask[i, j]:
                    weight = 0.02 if excess[i, j] > least else 1.0
                    # about the middle, so that no digits are lost
                    y, x, n = i - 0.5 * rows, j - 0.5 * columns, near[i, j]
                    row_sum[0] += weight
                    row_sum[1] += weight * y
                    row_sum[2] += weight * x
                    row_sum[3] += weight * y * y
                    row_sum[4] += weight * y * x
                    row_sum[5] += weight * x * x
                    row_sum[6] += weight * n
                    row_sum[7] += weight * y * n
                    row_sum[8] += weight * x * n
                for k in range(9):
                    total[i + 1, j + 1, k] = total[i, j + 1, k] + row_sum[k]
        for i in range(rows):
            top, bottom = max(i - radius, 0), min(i + radius + 1, rows)
            for j in range(columns):
                if not mask[i, j]:
                    continue
                left, right = max(j - radius, 0), min(j + radius + 1, columns)
                for k in range(9):
                    box[k] = (
                        total[bottom, right, k]
                        - total[top, right, k]
                        - total[bottom, left, k]
                        + total[top, left, k]
                    )
                weight = max(box[0], 1e-9)
                y, x, n = box[1] / weight, box[2] / weight, box[6] / weight
                yy = box[3] / weight - y * y + 1e-3
                xy = box[4] / weight - y * x
                xx = box[5] / weight - x * x + 1e-3
                yn, xn = box[7] / weight - y * n, box[8] / weight - x * n
                determinant = yy * xx - xy * xy
                slope_y = (yn * xx - xn * xy) / determinant
                slope_x = (xn * yy - yn * xy) / determinant
                plane = n + slope_y * (i - 0.5 * rows - y) + slope_x * (j - 0.5 * columns - x)
                excess[i, j] = near[i, j] - plane
    return excess
