"""What speaks for a branch: one row of numbers, free of scale and of the picture's rotation."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.parts.grid import (
    branch_sums,
    distances_at,
    solidity,
)
from shared.jit import kernel

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

ENCLOSES = 13
"""The feature that tells whether background shows between branch and body."""

_SMALLEST = 0.08
"""Variance of a cell's own extent, about, in cells squared."""


@kernel
def branch_features(
    mask: Mask,
    cells: Mask,
    distance: Array,
    holes: NDArray[np.int32],
    hole_sizes: NDArray[np.int64],
    near: Array,
    tall: Array,
) -> Array:
    """Return features (31,) of a branch.

    Its share and its contact with the rest; how thick it is beside the rest,
    and how far it reaches; solidity of both; holes, and those between them;
    spread of both along their principal axes and how these stand to each
    other; depth and height of both.

    Parameters
    ----------
    mask, cells : (H, W) bool array
        Cells of the object and of its branch; empty along the picture's border.
    distance : (H, W) array
        Of the object's cells from the background, in cells.
    holes : (H, W) int32 array
        Number of the hole that a cell belongs to, from 1; 0 for none.
    hole_sizes : (holes + 1,) array
        Their cells.
    near, tall : (H, W) array
        Nearness and height of the cells, in units of the square root of the area.
    """
    rest = mask & ~cells
    sums, touched = branch_sums(cells, rest, holes, len(hole_sizes) - 1, near, tall)
    away = distances_at(cells, ~rest)
    solid = np.array([solidity(rest), solidity(cells)])
    return branch_row(mask, cells, distance, away, hole_sizes, sums, touched, solid)


@kernel
def branch_row(
    mask: Mask,
    cells: Mask,
    distance: Array,
    away: Array,
    hole_sizes: NDArray[np.int64],
    sums: Array,
    touched: NDArray[np.bool_],
    solid: Array,
) -> Array:
    """Return the features (31,), given what other kernels measured.

    Parameters
    ----------
    mask, cells, distance, hole_sizes
        As in `branch_features`.
    away : (H, W) array
        Distance of the cells from the rest.
    sums, touched
        As `branch_sums` returns them.
    solid : (2,) array
        Solidity of the rest and of the branch.
    """
    thick, bulk, reach, far = 0.0, 1.0, 0.0, 0.0
    for i in range(mask.shape[0]):
        for j in range(mask.shape[1]):
            if cells[i, j]:
                thick = max(thick, distance[i, j])
                reach = max(reach, away[i, j])
                far += away[i, j]
            elif mask[i, j]:
                bulk = max(bulk, distance[i, j])
    own, other, contact = sums[0, 0], sums[1, 0], sums[2, 0]
    area = own + other
    size = np.sqrt(area)
    between = 0.0
    for k in range(1, len(hole_sizes)):
        if touched[k]:
            between += hole_sizes[k]
    long_, short, axis_y, axis_x = _spread(sums[0])
    body_long, body_short, body_y, body_x = _spread(sums[1])
    y, x = sums[0, 1] / own, sums[0, 2] / own
    out_y, out_x = 0.0, 0.0
    step = 0.0
    if contact > 0:
        out_y, out_x = _unit(y - sums[2, 1] / contact, x - sums[2, 2] / contact)
        step = sums[2, 6] / contact - sums[2, 7]
    radial_y, radial_x = _unit(y - sums[1, 1] / other, x - sums[1, 2] / other)
    return np.array(
        [
            own / area,
            contact / size,
            contact / (2 * thick),
            contact / np.sqrt(own),
            thick / bulk,
            thick / size,
            reach / size,
            reach / (2 * thick),
            far / own / size,
            solid[0],
            solid[1],
            hole_sizes[1:].sum() / area,
            between / area,
            1.0 if between > 0 else 0.0,
            long_ / size,
            short / size,
            body_long / size,
            body_short / size,
            abs(axis_y * out_y + axis_x * out_x),
            abs(radial_y * out_y + radial_x * out_x),
            abs(axis_y * radial_y + axis_x * radial_x),
            abs(body_y * radial_y + body_x * radial_x),
            step,
            sums[0, 6] / own - sums[1, 6] / other,
            sums[0, 8] - sums[0, 7],
            sums[0, 9] / own,
            sums[0, 11],
            sums[0, 10],
            sums[1, 9] / other,
            sums[1, 11],
            sums[1, 10],
        ]
    )


@kernel
def _unit(y: float, x: float) -> tuple[float, float]:
    length = max(np.sqrt(y * y + x * x), 1e-12)
    return y / length, x / length


@kernel
def _spread(sums: Array) -> tuple[float, float, float, float]:
    """Return standard deviations along the principal axes, and the longer axis (y, x)."""
    n = max(sums[0], 1.0)
    y, x = sums[1] / n, sums[2] / n
    yy, yx, xx = sums[3] / n - y * y, sums[4] / n - x * y, sums[5] / n - x * x
    mean, half = (yy + xx) / 2, np.sqrt((yy - xx) ** 2 / 4 + yx * yx)
    turn = 0.5 * np.arctan2(2 * yx, yy - xx)
    return (
        np.sqrt(max(mean + half, _SMALLEST)),
        np.sqrt(max(mean - half, _SMALLEST)),
        np.cos(turn),
        np.sin(turn),
    )
