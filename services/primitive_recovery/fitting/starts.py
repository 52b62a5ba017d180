"""What a part may be: starts of the fit, each with its priors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.fitting.contact import Contact
from services.primitive_recovery.fitting.terms import AT_MOST, EQUAL

Array = NDArray[np.float64]

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
    local = np.einsum("ni,fij->fnj", points, frames)
    lows, highs = local.min(axis=1), local.max(axis=1)
    stands = (True, False) if contact is not None and contact.possible else (False,)
    shared, by_frame = supports
    all_supports, priors, rotations, shapes, positions, odds = [], [], [], [], [], []
    for index, frame in enumerate(frames):
        rows = np.concatenate([shared, by_frame[index], np.zeros((1, 6))])
        rows[-1, 2], rows[-1, 4] = 1.0, np.inf
        turn = np.full(3, TURN)
        known = 0.0
        if level and index == 0:
            turn[:2] = LEVEL
            known = 2 * np.log(TURN / LEVEL)
        for stand in stands:
            low, high = lows[index].copy(), highs[index].copy()
            own, likely = rows, known
            if contact is not None:
                own = rows.copy()
                own[-1] = [*-contact.normal, contact.reach, contact.tolerance,
                           EQUAL if stand else AT_MOST]  # fmt: skip
            if stand and contact is not None:
                likely -= np.log(np.sqrt(2 * np.pi) * contact.tolerance)
                _down_to(contact, frame, low, high)
            size = high - low
            order = np.argsort(size)
            size = np.maximum(size, THINNEST * max(size[order[1]], THINNEST * size[order[2]]))
            half = np.log(size / 2)
            centre = frame @ ((low + high) / 2)
            for z in _main_axes(size, order.tolist()):
                axes = [(z + 1) % 3, (z + 2) % 3, z]
                all_supports.append(own)
                priors.append(
                    [*EXPONENTS, EXPONENTS_DEVIATION, SYMMETRY, half[z], LENGTH, *turn[axes]]
                )
                rotations.append(frame[:, axes])
                shapes.append([*EXPONENTS, *half[axes]])
                positions.append(centre)
                odds.append(likely)
    return Starts(
        np.array(all_supports),
        np.array(priors),
        np.ascontiguousarray(rotations),
        np.array(shapes),
        np.array(positions),
        np.array(odds),
    )


def _main_axes(size: Array, order: list[int]) -> tuple[int, int]:
    """Return the axis whose two others are most alike, and the other end of the sizes."""
    short, middle, long = order
    if size[middle] * size[middle] < size[short] * size[long]:
        return long, short
    return short, long


def _down_to(contact: Contact, frame: Array, low: Array, high: Array) -> None:
    """Extend a box to the plane, in place, if one of its axes is about upright."""
    down = -(contact.normal @ frame)
    k = int(np.argmax(np.abs(down)))
    if down[k] > 0.9:
        high[k] = max(high[k], contact.reach)
    elif down[k] < -0.9:
        low[k] = min(low[k], -contact.reach)
