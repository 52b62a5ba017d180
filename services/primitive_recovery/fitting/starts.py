"""What a part may be: starts of the fit, each with its priors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.fitting.contact import Contact
from services.primitive_recovery.fitting.terms import AT_MOST, EQUAL
from shared.jit import kernel
from shared.sorting import ascending_order

Array = NDArray[np.float64]
Axes = NDArray[np.int64]
Mask = NDArray[np.bool_]

EXPONENTS, EXPONENTS_DEVIATION = (0.4, 0.8), 0.5
SYMMETRY = 0.15
"""Deviation of log(a1 / a2): things are about as deep as wide, unless the points differ."""
LENGTH = 3.0
TURN, LEVEL = 0.3, 0.01
"""Deviations in radians of a frame's turn, and of the tilt of one that lies level."""
THINNEST = 0.1
"""Thickness that a start has at least, as a share of its middle extent."""


@dataclass(frozen=True)
class Starts:
    """H starts, as `descent.search` wants them."""

    supports: Array
    priors: Array
    rotations: Array
    shapes: Array
    positions: Array
    odds: Array


def all_starts(
    points: Array,
    frames: Array,
    level: bool,
    supports: tuple[Array, Array],
    contact: Contact | None,
) -> Starts:
    """Return every combination of frame, main axis, and of standing on the plane or not.

    Each narrower assumption is likelier by how much it narrows (Occam's factor): to stand on
    the plane, by the part's size over the contact's tolerance; to be level, by the usual
    turn over the usual tilt, for each of two angles.

    Parameters
    ----------
    points : (c, 3) array
        In the unit of the fit: the farthest is 1 from the origin.
    frames : (F, 3, 3) array
    level : bool
        The first frame has the plane's normal, or up, for its third axis.
    supports : (K, 6), (F, 6, 6) arrays
        Those of all frames and those of each, in the unit of the fit.
    contact : Contact, optional
    """
    stands = np.array([True, False] if contact is not None and contact.possible else [False])
    plane = np.array([0.0, 0.0, 1.0, 0.0, np.inf])
    likely = np.zeros((len(frames), len(stands)))
    turns = np.full((len(frames), 3), TURN)
    if level:
        turns[0, :2] = LEVEL
        likely[0] += 2 * np.log(TURN / LEVEL)
    if contact is not None:
        plane = np.array([*-contact.normal, contact.reach, contact.tolerance])
        likely[:, stands] -= np.log(np.sqrt(2 * np.pi) * contact.tolerance)
    low, high = boxes(points, frames, plane[:3] @ frames, plane[3], stands)
    size, main = proportions(low, high, THINNEST)
    half = np.log(size / 2)
    centre = (frames[:, None] @ ((low + high) / 2)[..., None])[..., 0]
    says = np.where(stands, EQUAL, AT_MOST)
    about = np.array([*EXPONENTS, EXPONENTS_DEVIATION, SYMMETRY, LENGTH])
    return Starts(
        *combined(*supports, plane, says, about, turns, frames, half, main, centre, likely)
    )


@kernel
def boxes(
    points: Array, frames: Array, down: Array, reach: float, stands: Mask
) -> tuple[Array, Array]:
    """Return the lowest and the highest corner (F, S, 3) of points (c, 3) in each frame.

    Where they stand on a plane, the box goes down to it if one of its axes is about upright.

    Parameters
    ----------
    frames : (F, 3, 3) array
    down : (F, 3) array
        Minus the plane's normal, in each frame.
    reach : float
        How far the plane is along it.
    stands : (S,) bool array
    """
    low = np.full((len(frames), len(stands), 3), np.inf)
    high = np.full((len(frames), len(stands), 3), -np.inf)
    for f in range(len(frames)):
        for n in range(len(points)):
            for j in range(3):
                value = 0.0
                for i in range(3):
                    value += points[n, i] * frames[f, i, j]
                low[f, :, j] = np.minimum(low[f, :, j], value)
                high[f, :, j] = np.maximum(high[f, :, j], value)
        k = np.argmax(np.abs(down[f]))
        for s in range(len(stands)):
            if stands[s] and down[f, k] > 0.9:
                high[f, s, k] = max(high[f, s, k], reach)
            elif stands[s] and down[f, k] < -0.9:
                low[f, s, k] = min(low[f, s, k], -reach)
    return low, high


@kernel
def proportions(low: Array, high: Array, thinnest: float) -> tuple[Array, Axes]:
    """Return sizes (F, S, 3) of boxes, and their main axes (F, S, 2).

    The axis whose two others are most alike, and the other end of the sizes. No size is less
    than a share of the middle one, nor that of the same share of the longest.
    """
    size = high - low
    main = np.empty((*size.shape[:2], 2), dtype=np.int64)
    for f in range(size.shape[0]):
        for s in range(size.shape[1]):
            own = size[f, s]
            order = ascending_order(own)
            short, middle, long = order[0], order[1], order[2]
            least = thinnest * max(own[middle], thinnest * own[long])
            for k in range(3):
                own[k] = max(own[k], least)
            if own[middle] * own[middle] < own[short] * own[long]:
                short, long = long, short
            main[f, s, 0], main[f, s, 1] = short, long
    return size, main


@kernel
def combined(
    shared: Array,
    by_frame: Array,
    plane: Array,
    says: Array,
    about: Array,
    turns: Array,
    frames: Array,
    half: Array,
    main: Axes,
    centre: Array,
    likely: Array,
) -> tuple[Array, Array, Array, Array, Array, Array]:
    """Return the fields of `Starts`, for F frames, S ways to stand and two main axes.

    Parameters
    ----------
    shared, by_frame : (K, 6), (F, 6, 6) arrays
        Supports.
    plane, says : (5,), (S,) arrays
        Support of the plane, and what it says.
    about : (5,) array
        Exponents, their deviation, those of the symmetry and of the length.
    turns : (F, 3) array
        Deviations of each frame's turn.
    frames : (F, 3, 3) array
    half, main, centre : (F, S, 3), (F, S, 2), (F, S, 3) arrays
        Logarithms of the semi-axes, main axes, and centres.
    likely : (F, S) array
        Logarithms of the odds.
    """
    kinds = len(says)
    count, first = 2 * len(frames) * kinds, len(shared)
    supports, priors = np.empty((count, first + 7, 6)), np.empty((count, 9))
    rotations, shapes = np.empty((count, 3, 3)), np.empty((count, 5))
    positions, odds = np.empty((count, 3)), np.empty(count)
    for h in range(count):
        f, s = h // (2 * kinds), h // 2 % kinds
        z = main[f, s, h % 2]
        supports[h, :first] = shared
        supports[h, first : first + 6] = by_frame[f]
        supports[h, first + 6, :5] = plane
        supports[h, first + 6, 5] = says[s]
        priors[h, :4] = about[:4]
        priors[h, 4], priors[h, 5] = half[f, s, z], about[4]
        shapes[h, :2] = about[:2]
        for k in range(3):
            axis = (z + 1 + k) % 3
            priors[h, 6 + k] = turns[f, axis]
            rotations[h, :, k] = frames[f, :, axis]
            shapes[h, 2 + k] = half[f, s, axis]
        positions[h] = centre[f, s]
        odds[h] = likely[f, s]
    return supports, priors, rotations, shapes, positions, odds
