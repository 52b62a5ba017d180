"""Does a hand touch anything on its straight way in? Points against its swept boxes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.hand import Hand
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.workspace import Workspace
from shared.jit import kernel

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_MARGIN = 0.001


def finger_hits(placed: Placements, hand: Hand, opening: Array, points: Array) -> Mask:
    """Say which hands (G,) touch a point (N, 3) with a finger on their way in.

    Parameters
    ----------
    placed : Placements
        The part lies between `left` and `right`; the hand is centred on them.
    hand : Hand
    opening : (G,) array
        Distance between the pads on the way.
    points : (N, 3) array
    """
    inner, tip = opening / 2 - _MARGIN, placed.tip
    outer = inner + hand.finger_thickness + 2 * _MARGIN
    back = tip - hand.finger_length - hand.pregrasp
    return _boxes_hit(
        placed, hand.finger_width / 2 + _MARGIN, inner, outer, back, tip + _MARGIN, points
    )


def palm_hits(placed: Placements, hand: Hand, points: Array) -> Mask:
    """Say which hands (G,) touch a point (N, 3) with the palm on their way in."""
    front = placed.tip - hand.finger_length
    outer = np.full(len(placed), hand.palm_size[1] / 2 + _MARGIN)
    back = front - hand.pregrasp - hand.palm_size[2]
    half_width = hand.palm_size[0] / 2 + _MARGIN
    return _boxes_hit(placed, half_width, -outer, outer, back, front + hand.palm_clearance, points)


def touches_obstacle(placed: Placements, hand: Hand, opening: Array, obstacles: Array) -> Mask:
    """Say which hands (G,) meet an obstacle with a finger, the palm or between the pads."""
    outer, back = opening / 2, placed.tip - hand.finger_length
    between = _boxes_hit(placed, hand.finger_width / 2, -outer, outer, back, placed.tip, obstacles)
    hit = finger_hits(placed, hand, opening, obstacles) | palm_hits(placed, hand, obstacles)
    return np.asarray(hit | between)


def comes_near(placed: Placements, hand: Hand, opening: Array, points: Array, away: float) -> Mask:
    """Say which hands (G,) come closer than `away` to a point (N, 3) on their straight way in.

    Fingers, palm and the space between the fingers count, each as a box that is `away`
    metres larger on every side.
    """
    if not len(points):
        return np.zeros(len(placed), dtype=np.bool_)
    back = placed.tip - hand.finger_length - hand.pregrasp
    outer = opening / 2 + hand.finger_thickness + away
    none = np.full(len(placed), -away)
    half_width = hand.finger_width / 2 + away
    fingers = _boxes_hit(placed, half_width, none, outer, back, placed.tip + away, points)
    outer = np.full(len(placed), hand.palm_size[1] / 2 + away)
    front = placed.tip - hand.finger_length + away
    half_width = hand.palm_size[0] / 2 + away
    palm = _boxes_hit(placed, half_width, none, outer, back - hand.palm_size[2], front, points)
    return np.asarray(fingers | palm)


def _boxes_hit(
    placed: Placements,
    half_width: float,
    inner: Array,
    outer: Array,
    back: Array,
    front: Array,
    points: Array,
) -> Mask:
    """Say which hands (G,) have a point (N, 3) in a box on either side of their middle.

    `half_width` of the box along x, from `inner` to `outer` along y from the middle of
    the part, from `back` to `front` along z.
    """
    middle = (placed.left + placed.right) / 2
    limits = np.column_stack([middle, inner, outer, back, front])
    return any_inside(placed.origin, placed.rotation, half_width, limits, points)


@kernel
def any_inside(
    origin: Array, rotation: Array, half_width: float, limits: Array, points: Array
) -> Mask:
    """Say which frames (G,) have one of the points (N, 3) in their box.

    Inside is |x| < half_width, inner < |y - middle| < outer and back < z < front in the
    frame of `origin` (G, 3) and `rotation` (G, 3, 3); `limits` (G, 5) in this order.
    """
    hit = np.zeros(len(origin), dtype=np.bool_)
    columns = points.T.copy()
    px, py, pz = columns[0], columns[1], columns[2]
    for g in range(len(origin)):
        r, o = rotation[g], origin[g]
        middle, inner, outer, back, front = limits[g]
        x0 = r[0, 0] * o[0] + r[1, 0] * o[1] + r[2, 0] * o[2]
        y0 = r[0, 1] * o[0] + r[1, 1] * o[1] + r[2, 1] * o[2] + middle
        z0 = r[0, 2] * o[0] + r[1, 2] * o[1] + r[2, 2] * o[2]
        xx, xy, xz = r[0, 0], r[1, 0], r[2, 0]
        yx, yy, yz = r[0, 1], r[1, 1], r[2, 1]
        zx, zy, zz = r[0, 2], r[1, 2], r[2, 2]
        count = 0
        for n in range(len(px)):  # without branches: vector instructions
            x = abs(xx * px[n] + xy * py[n] + xz * pz[n] - x0)
            y = abs(yx * px[n] + yy * py[n] + yz * pz[n] - y0)
            z = zx * px[n] + zy * py[n] + zz * pz[n] - z0
            count += (x < half_width) & (y > inner) & (y < outer) & (z > back) & (z < front)
        hit[g] = count > 0
    return hit


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
