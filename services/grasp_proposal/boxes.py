"""Does a hand touch anything on its straight way in? Points against its swept boxes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.hand import Hand
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.workspace import Workspace

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_MARGIN = 0.001
_CHUNK = 400_000


def local_coordinates(placed: Placements, points: Array) -> NDArray[np.float32]:
    """Return points (N, 3) in the frame of each placement's origin: (G, 3, N)."""
    rotation = placed.rotation.astype(np.float32)
    shift = np.einsum("gij,gi->gj", placed.rotation, placed.origin).astype(np.float32)
    turned = np.matmul(rotation.transpose(0, 2, 1), points.T.astype(np.float32)[None])
    return np.asarray(turned - shift[:, :, None])


def chunks(rows: int, columns: int) -> list[slice]:
    """Return slices of rows that keep a (rows, columns) table small."""
    size = max(1, _CHUNK // max(1, columns))
    return [slice(start, start + size) for start in range(0, rows, size)]


def finger_hits(placed: Placements, hand: Hand, opening: Array, local: NDArray[np.float32]) -> Mask:
    """Say which hands (G,) touch a point with a finger on their way in.

    Parameters
    ----------
    placed : Placements
        The part lies between `left` and `right`; the hand is centred on them.
    hand : Hand
    opening : (G,) array
        Distance between the pads on the way.
    local : (G, 3, N) array
        The points, from `local_coordinates`.
    """
    tip = placed.tip[:, None]
    y = _from_centre(placed, local) - opening[:, None] / 2
    hit = (np.abs(local[:, 0]) < hand.finger_width / 2 + _MARGIN) & (local[:, 2] < tip + _MARGIN)
    hit &= local[:, 2] > tip - hand.finger_length - hand.pregrasp
    return np.asarray((hit & (y > -_MARGIN) & (y < hand.finger_thickness + _MARGIN)).any(axis=1))


def palm_hits(placed: Placements, hand: Hand, local: NDArray[np.float32]) -> Mask:
    """Say which hands (G,) touch a point (G, 3, N) with the palm on their way in."""
    front = (placed.tip - hand.finger_length)[:, None]
    hit = np.abs(local[:, 0]) < hand.palm_size[0] / 2 + _MARGIN
    hit &= _from_centre(placed, local) < hand.palm_size[1] / 2 + _MARGIN
    hit &= local[:, 2] < front + hand.palm_clearance
    hit &= local[:, 2] > front - hand.pregrasp - hand.palm_size[2]
    return np.asarray(hit.any(axis=1))


def _from_centre(placed: Placements, local: NDArray[np.float32]) -> NDArray[np.float32]:
    centre = ((placed.left + placed.right) / 2).astype(np.float32)
    return np.asarray(np.abs(local[:, 1] - centre[:, None]))


def touches_obstacle(placed: Placements, hand: Hand, opening: Array, obstacles: Array) -> Mask:
    """Say which hands (G,) meet an obstacle with a finger, the palm or between the pads."""
    touched = np.zeros(len(placed), dtype=np.bool_)
    for rows in chunks(len(placed), len(obstacles)):
        part = placed.take(np.arange(len(placed))[rows])
        local = local_coordinates(part, obstacles)
        enclosed = np.abs(local[:, 0]) < hand.finger_width / 2
        enclosed &= _from_centre(part, local) < opening[rows][:, None] / 2
        enclosed &= local[:, 2] < part.tip[:, None]
        enclosed &= local[:, 2] > (part.tip - hand.finger_length)[:, None]
        touched[rows] = finger_hits(part, hand, opening[rows], local) | palm_hits(part, hand, local)
        touched[rows] |= enclosed.any(axis=1)
    return touched


def support_clearance(
    placed: Placements, hand: Hand, opening: Array, workspace: Workspace
) -> tuple[Array, Array]:
    """Return the lowest heights (G,) of the finger tips and of the palm, inf without a plane.

    The lowest over the straight way in: its ends, since heights change linearly.
    """
    if workspace.up is None or workspace.support_offset is None:
        free = np.full(len(placed), np.inf)
        return free, free
    rise = np.einsum("gij,i->gj", placed.rotation, workspace.up)
    base = workspace.heights(placed.origin) + rise[:, 1] * (placed.left + placed.right) / 2
    sideways = np.abs(rise[:, 0]) * hand.finger_width / 2
    sideways = sideways + np.abs(rise[:, 1]) * (opening / 2 + hand.finger_thickness)
    fingers = (
        _lowest(base, rise[:, 2], placed.tip - hand.finger_length, placed.tip, hand) - sideways
    )
    back = placed.tip - hand.finger_length - hand.palm_size[2]
    palm = _lowest(base, rise[:, 2], back, placed.tip - hand.finger_length, hand)
    palm = palm - np.abs(rise[:, 0]) * hand.palm_size[0] / 2
    return fingers, palm - np.abs(rise[:, 1]) * hand.palm_size[1] / 2


def _lowest(base: Array, rise: Array, back: Array, front: Array, hand: Hand) -> Array:
    return np.asarray(base + np.minimum(rise * front, rise * (back - hand.pregrasp)))
