"""Kernel of the closer look: what each hand holds, and where its pads would touch it.

The loops are in one file, because numba's cache only notices changes in the file of the
function that is called.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]
Rows = NDArray[np.int64]
Mask = NDArray[np.bool_]

CONTINUES = 0.006
"""How far beyond the pads the surface is looked at, metres."""
STRIPS = 4
"""Into how many strips a pad's width is divided."""
_EDGE = 0.003
_EDGE_MARGIN = 0.001
_CORNER = 0.004


class Held(NamedTuple):
    """What a hand holds: so many points, from `left` to `right` along y, from `front` along z."""

    number: int
    left: float
    right: float
    front: float


class PadMarks(NamedTuple):
    """What each of G hands has at one pad, sums over the points that the pad touches.

    Attributes
    ----------
    touched, in_focus, strips : (G,) arrays
        Points that the pad touches, those of them in focus, and strips of the pad's width
        that have one.
    x : (G,) array
        Mean coordinate along the hand's x.
    normal, centre : (G, 3) arrays
        Sum of the normals; mean point.
    scatter : (G, 3, 3) array
        About the mean point.
    goes_on, widens : (G,) bool arrays
        The surface goes on beyond the pad within its width; beside it.
    """

    touched: Array
    in_focus: Array
    strips: Array
    x: Array
    normal: Array
    centre: Array
    scatter: Array
    goes_on: Mask
    widens: Mask


class Look(NamedTuple):
    """What each of G hands holds: as in `Held`, how many points in focus, and both pads."""

    number: Array
    in_focus: Array
    left: Array
    right: Array
    front: Array
    left_pad: PadMarks
    right_pad: PadMarks


@kernel
def look_closer(
    points: Array,
    normals: Array,
    focus: Mask,
    origin: Array,
    rotation: Array,
    extent: Array,
    finger_width: float,
) -> Look:
    """Measure what G hands hold of the points (N, 3).

    Parameters
    ----------
    points, normals, focus : (N, 3), (N, 3), (N,) arrays
        The surface, and where a grasp is wanted.
    origin, rotation : (G, 3), (G, 3, 3) arrays
        The hands' frames.
    extent : (G, 3) array
        How far the tips reach along z; left and right edge of the part along y.
    finger_width : float
        Along x.
    """
    hands = len(origin)
    numbers = np.zeros((5, hands))
    look = Look(
        numbers[0],
        numbers[1],
        numbers[2],
        numbers[3],
        numbers[4],
        _no_marks(hands),
        _no_marks(hands),
    )
    columns = points.T.copy()
    room, rows = np.empty(columns.shape), np.empty(len(points), dtype=np.int64)
    marks = np.empty(len(points), dtype=np.bool_)
    half_width = finger_width / 2
    for g in range(hands):
        tip = extent[g, 0]
        size = _cut_slab(
            columns, origin[g], rotation[g], half_width + CONTINUES, tip + CONTINUES, room, rows
        )
        local, index, held = room[:, :size], rows[:size], marks[:size]
        part = _mark_held(local, half_width, tip, extent[g, 1], extent[g, 2], held)
        for i in range(size):
            look.in_focus[g] += held[i] and focus[index[i]]
        look.number[g] = part.number
        look.left[g], look.right[g], look.front[g] = part.left, part.right, part.front
        slab = local, points, normals, focus, index, held, finger_width, tip
        _mark_pad(*slab, -1.0, part.left, look.left_pad, g)
        _mark_pad(*slab, 1.0, part.right, look.right_pad, g)
    return look


@kernel
def _no_marks(hands: int) -> PadMarks:
    return PadMarks(
        np.zeros(hands),
        np.zeros(hands),
        np.zeros(hands),
        np.zeros(hands),
        np.zeros((hands, 3)),
        np.zeros((hands, 3)),
        np.zeros((hands, 3, 3)),
        np.zeros(hands, dtype=np.bool_),
        np.zeros(hands, dtype=np.bool_),
    )


@kernel
def _cut_slab(
    columns: Array,
    origin: Array,
    rotation: Array,
    half_width: float,
    deepest: float,
    local: Array,
    index: Rows,
) -> int:
    """Find the points within `half_width` along the hand's x and less deep than `deepest`.

    Parameters
    ----------
    columns : (3, N) array
        The points' x, y and z.
    origin, rotation : (3,), (3, 3) arrays
        The hand's frame.
    local : (3, N) array
        Gets the coordinates of the points found, in the hand's frame, in its first columns.
    index : (N,) array
        Gets their rows.

    Returns
    -------
    int
        How many there are.
    """
    px, py, pz = columns[0], columns[1], columns[2]
    for axis in (0, 2):  # nothing but sums of products: vector instructions
        a, b, c = rotation[0, axis], rotation[1, axis], rotation[2, axis]
        shift = a * origin[0] + b * origin[1] + c * origin[2]
        along = local[axis]
        for n in range(len(px)):
            along[n] = a * px[n] + b * py[n] + c * pz[n] - shift
    a, b, c = rotation[0, 1], rotation[1, 1], rotation[2, 1]
    shift = a * origin[0] + b * origin[1] + c * origin[2]
    across, ahead = local[0], local[2]
    count = np.uint64(0)
    for n in range(len(px)):  # without branches: see placing.py
        x, z = across[n], ahead[n]
        index[count], across[count], ahead[count] = n, x, z
        count += np.uint64((abs(x) < half_width) & (z < deepest))
    for i in range(count):
        row = np.uint64(index[i])
        local[1, i] = a * px[row] + b * py[row] + c * pz[row] - shift
    return int(count)


@kernel
def _mark_held(
    local: Array, half_width: float, tip: float, left: float, right: float, held: Mask
) -> Held:
    """Mark the points (3, n) between the pads; exact edges of them, zeros when there are none."""
    count = 0
    low, high, front = np.inf, -np.inf, np.inf
    for i in range(local.shape[1]):
        x, y, z = local[0, i], local[1, i], local[2, i]
        held[i] = abs(x) < half_width and z < tip and left - _EDGE_MARGIN < y < right + _EDGE_MARGIN
        if held[i]:
            count += 1
            low, high, front = min(low, y), max(high, y), min(front, z)
    if count == 0:
        return Held(0, 0.0, 0.0, 0.0)
    return Held(count, low, high, front)


@kernel
def _mark_pad(
    local: Array,
    points: Array,
    normals: Array,
    focus: Mask,
    index: Rows,
    held: Mask,
    finger_width: float,
    tip: float,
    sign: float,
    edge: float,
    pad: PadMarks,
    g: int,
) -> None:
    """Fill row `g` of the marks of one pad, left (`sign` -1) or right (+1) of the part's edge."""
    half_width = finger_width / 2
    filled = np.zeros(STRIPS, dtype=np.bool_)
    for i in range(local.shape[1]):
        x, z = local[0, i], local[2, i]
        outwards = sign * (local[1, i] - edge)
        if held[i] and outwards > -_EDGE:
            pad.touched[g] += 1.0
            pad.in_focus[g] += focus[index[i]]
            pad.x[g] += x
            for axis in range(3):
                pad.normal[g, axis] += normals[index[i], axis]
                pad.centre[g, axis] += points[index[i], axis]
            strip = int((x / finger_width + 0.5) * STRIPS)
            filled[min(max(strip, 0), STRIPS - 1)] = True
        if abs(x) < half_width and 0.0 < outwards < CONTINUES:
            pad.goes_on[g] = True
        if abs(x) > half_width and _CORNER < outwards < 3 * _CORNER and z < tip:
            pad.widens[g] = True
    number = max(pad.touched[g], 1.0)
    pad.strips[g] = filled.sum()
    pad.x[g] /= number
    pad.centre[g] /= number
    for i in range(local.shape[1]):
        if held[i] and sign * (local[1, i] - edge) > -_EDGE:
            for a in range(3):
                for b in range(3):
                    pad.scatter[g, a, b] += (points[index[i], a] - pad.centre[g, a]) * (
                        points[index[i], b] - pad.centre[g, b]
                    )
