"""An object in slices across one of its axes: widths, heights and relief along it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.parts.projection import across
from shared.jit import kernel
from shared.sorting import ascending, trimmed_range

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

SLICES = 64
"""Of every profile; a cut can lie between any two."""

NOTHING = np.empty((0, 3))

_FEWEST_SLICES = 8
_TRIMS = np.array([0.02, 0.05, 0.05])
"""Share of a slice's points beyond each edge, height and depth: strays of the sensor."""

_ENDS = 0.001
"""Share of all points beyond each end of the axis."""

_WANTED: Array = np.arange(0.5, SLICES)
"""Middles of the slices."""


@dataclass(frozen=True)
class Profile:
    """Slices along an axis, of equal thickness; lengths in metres.

    Attributes
    ----------
    axis : (3,) array
        Unit vector.
    place : (N,) array
        Of every point along the axis: 0 at its lower end, SLICES at its upper.
    step : float
        Thickness of a slice.
    width, middle : (SLICES,) array
        Distance between the two silhouette edges, seen across axis and ray, and
        where the middle between them lies. The width is not biased by the
        unseen back, since both edges are seen.
    filled : (SLICES,) array
        Share of the width where the object was seen, not background.
    top, bottom : (SLICES,) array
        Heights above the support, or along the ray where there is none.
    relief, depth : (SLICES,) array
        How far the slice's surface reaches towards the sensor, and its mean there.
    """

    axis: Array
    place: Array
    step: float
    width: Array
    middle: Array
    filled: Array
    top: Array
    bottom: Array
    relief: Array
    depth: Array

    @property
    def length(self) -> float:
        return SLICES * self.step

    @property
    def size(self) -> float:
        """Side of the square of the silhouette's area: what lengths are measured by."""
        return float(np.sqrt(max(self.width.sum() * self.step, 1e-300)))


def profile(
    points: Array,
    axis: Array,
    ray: Array,
    height: Array,
    spacing: float,
    hidden: Array = NOTHING,
) -> Profile:
    """Return the profile of points (N, 3) along a unit axis (3,), seen along a unit ray (3,).

    Parameters
    ----------
    points : (N, 3) array
        Metres, about their mean.
    axis, ray : (3,) array
        Unit vectors.
    height : (N,) array
        Of each point above its support, metres.
    spacing : float
        About how far neighbouring points are apart, metres.
    hidden : (U, 3) array, optional
        Places beside the points where something else is in front. A slice that ends
        there reaches at least so far: its edge is then where its neighbours' edges are.
    """
    towards, aside = across(axis, ray)
    towards = -towards if towards @ ray > 0 else towards
    along = points @ axis
    low, high = trimmed_range(along, round(_ENDS * len(along)))
    length = max(high - low, 1e-12)
    count = int(np.clip(length / (1.5 * spacing), _FEWEST_SLICES, SLICES))
    place, index = sliced(along, low, length, count)

    side, near = points @ aside, points @ towards
    values = np.stack([side, height, near])
    number, ranges, depth = slice_ranges(values, index, count, _TRIMS)
    (left, right), (bottom, top), (far, close) = ranges
    centres = np.asarray((np.arange(count) + 0.5) * (SLICES / count), dtype=np.float64)
    known = number > 0
    edges = known
    where = np.floor((hidden @ axis - low) / length * count).astype(np.intp)
    inside = (where >= 0) & (where < count)
    if inside.any():
        where, beside = where[inside], hidden[inside] @ aside
        reach = hidden_reach(beside, where, left, right, 1.5 * spacing)
        seen = right - left
        left, right = _completed(left, right, reach, known, centres)
        # Of a slice that is hidden for the most part nothing but its edges is known.
        known = known & (2 * seen >= right - left)
        side, index = np.concatenate([side, beside]), np.concatenate([index, where])
    filled = filled_share(side, index, left, right, 1.5 * spacing)
    width, middle, filled = interpolated(
        _WANTED, centres, edges, np.stack([right - left, (left + right) / 2, filled])
    )
    top, bottom, relief, depth = interpolated(
        _WANTED, centres, known, np.stack([top, bottom, close - far, depth])
    )
    return Profile(
        axis=axis,
        place=place,
        step=length / SLICES,
        width=np.maximum(width, 0.5 * spacing),
        middle=middle,
        filled=filled,
        top=top,
        bottom=bottom,
        relief=relief,
        depth=depth,
    )


def _completed(
    left: Array, right: Array, reach: Array, known: NDArray[np.bool_], centres: Array
) -> tuple[Array, Array]:
    """Return edges (count,) of slices: hidden ones in line with those seen before and after.

    Parameters
    ----------
    left, right : (count,) array
        Edges as far as they were seen.
    reach : (2, count) array
        How far they may really lie out, as something hides what is beyond.
    known : (count,) array
        Slices with points.
    centres : (count,) array
        Places of the slices along the axis.
    """
    fixed_left, fixed_right = known & (reach[0] >= left), known & (reach[1] <= right)
    if fixed_left.any():
        wanted = np.interp(centres, centres[fixed_left], left[fixed_left])
        left = np.minimum(left, np.maximum(wanted, reach[0]))
    if fixed_right.any():
        wanted = np.interp(centres, centres[fixed_right], right[fixed_right])
        right = np.maximum(right, np.minimum(wanted, reach[1]))
    return left, right


@kernel
def sliced(along: Array, low: float, length: float, count: int) -> tuple[Array, Indices]:
    """Return where points lie between the ends of an axis, in units of SLICES and as slices.

    Parameters
    ----------
    along : (N,) array
        Of every point along the axis, metres.
    low, length : float
        Where the axis begins, and how long it is; what is beyond is at its end.
    count : int
        How many slices there are.

    Returns
    -------
    place : (N,) array
        From 0 to SLICES.
    index : (N,) array
        Slice of every point.
    """
    place = np.empty(len(along))
    index = np.empty(len(along), dtype=np.int64)
    for k in range(len(along)):
        share = min(max((along[k] - low) / length, 0.0), 1.0)
        place[k] = share * SLICES
        index[k] = min(int(share * count), count - 1)
    return place, index


@kernel
def interpolated(wanted: Array, at: Array, known: NDArray[np.bool_], values: Array) -> Array:
    """Return rows of values, known at some places, linearly between: `np.interp` by row.

    Parameters
    ----------
    wanted : (W,) array
        Where they are wanted, ascending; beyond the known ones the values stay.
    at : (K,) array
        Ascending.
    known : (K,) bool array
        One of them at least.
    values : (V, K) array

    Returns
    -------
    (V, W) array
    """
    held = np.flatnonzero(known)
    found = np.empty((len(values), len(wanted)))
    j = 0
    for k in range(len(wanted)):
        x = wanted[k]
        while j + 1 < len(held) and at[held[j + 1]] <= x:
            j += 1
        one = held[j]
        if x <= at[one] or j + 1 == len(held):
            found[:, k] = values[:, one]
            continue
        other = held[j + 1]
        for v in range(len(values)):
            slope = (values[v, other] - values[v, one]) / (at[other] - at[one])
            found[v, k] = slope * (x - at[one]) + values[v, one]
    return found


@kernel
def slice_ranges(
    values: Array, index: Indices, count: int, trims: Array
) -> tuple[Indices, Array, Array]:
    """Return how many points every slice has, the range of each value there, and the last's mean.

    Parameters
    ----------
    values : (V, N) array
        Of every point.
    index : (N,) array
        Slice of every point.
    count : int
        How many slices there are.
    trims : (V,) array
        Share of a slice's points left out at either end of a value's range.

    Returns
    -------
    number : (count,) array
    ranges : (V, 2, count) array
        Lowest and highest value; 0 in slices without points.
    mean : (count,) array
    """
    number = np.zeros(count, dtype=np.int64)
    for each in index:
        number[each] += 1
    start = np.zeros(count + 1, dtype=np.int64)
    for each in range(count):
        start[each + 1] = start[each] + number[each]
    ranges = np.zeros((len(values), 2, count))
    mean = np.zeros(count)
    held = np.empty(len(index))
    for v in range(len(values)):
        end = start[:-1].copy()
        for k in range(len(index)):
            held[end[index[k]]] = values[v, k]
            end[index[k]] += 1
        for each in range(count):
            n = number[each]
            if n == 0:
                continue
            own = held[start[each] : start[each + 1]]
            skip = int(trims[v] * n)
            if v < len(values) - 1:
                ranges[v, 0, each], ranges[v, 1, each] = trimmed_range(own, skip)
            else:
                own = ascending(own)
                ranges[v, 0, each], ranges[v, 1, each] = own[skip], own[n - 1 - skip]
                mean[each] = own.mean()
    return number, ranges, mean


@kernel
def filled_share(side: Array, index: Indices, left: Array, right: Array, cell: float) -> Array:
    """Return what share of the cells between a slice's edges (count,) holds a point.

    Parameters
    ----------
    side : (N,) array
        Where each point lies across the slice, metres.
    index : (N,) array
        Its slice.
    left, right : (count,) array
        Edges of the slices, metres.
    cell : float
        Size of the cells, metres.
    """
    columns = np.maximum(((right - left) / cell).astype(np.int64) + 1, 1)
    seen = np.zeros((len(left), columns.max()), dtype=np.bool_)
    for k in range(len(side)):
        each = index[k]
        if side[k] <= right[each]:
            column = int(max(side[k] - left[each], 0.0) / cell)
            seen[each, min(column, columns[each] - 1)] = True
    found = np.zeros(len(left))
    for each in range(len(left)):
        found[each] = seen[each].sum() / columns[each]
    return found


@kernel
def hidden_reach(side: Array, index: Indices, left: Array, right: Array, cell: float) -> Array:
    """Return how far beyond its edges (2, count) a slice is hidden without a gap.

    The edges themselves where nothing hides what is beyond them.

    Parameters
    ----------
    side : (U,) array
        Where each hidden place lies across the slices, metres.
    index : (U,) array
        Its slice.
    left, right : (count,) array
        Edges of the slices, metres.
    cell : float
        Size of a place, metres; gaps of one cell are none.
    """
    count = len(left)
    reach = np.empty((2, count))
    reach[0], reach[1] = left, right
    low, high = min(side.min(), left.min()), max(side.max(), right.max())
    columns = int((high - low) / cell) + 1
    taken = np.zeros((count, columns), dtype=np.bool_)
    for k in range(len(side)):
        taken[index[k], int((side[k] - low) / cell)] = True
    for each in range(count):
        for way in range(2):
            step = 2 * way - 1
            at = int((reach[way, each] - low) / cell)
            for _ in range(columns):
                if 0 <= at + step < columns and taken[each, at + step]:
                    at += step
                elif 0 <= at + 2 * step < columns and taken[each, at + 2 * step]:
                    at += 2 * step
                else:
                    break
                edge = low + (at + way) * cell
                reach[way, each] = (
                    max(reach[1, each], edge) if way == 1 else min(reach[0, each], edge)
                )
    return reach
