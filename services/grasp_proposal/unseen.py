"""Where the superquadrics say that the object goes on behind what the sensor saw."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.contacts import Contacts
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.visibility import SightMap
from services.grasp_proposal.workspace import Workspace
from shared.jit import kernel

Array = NDArray[np.float64]


class Unseen(NamedTuple):
    """What each of G hands would meet of the unseen surface.

    Attributes
    ----------
    more, less : (G,) arrays
        How far the tips would have to sink into it, metres; the worse finger and the better.
    width : (G,) array
        Of what is between and below the fingers, seen and unseen, metres.
    """

    more: Array
    less: Array
    width: Array


def meet_unseen(
    workspace: Workspace, hand: Hand, contacts: Contacts, sight: SightMap | None
) -> Unseen:
    """Return what hands would meet; nothing without superquadrics or a `sight`."""
    placed = contacts.placed
    surface = workspace.believed
    if sight is not None and len(surface):
        above = workspace.heights(surface) > 0
        surface = surface[above & (sight.depth_behind(surface) > 0)]
    else:
        surface = surface[:0]
    limits = np.column_stack([placed.left, placed.right, contacts.opening / 2, placed.tip])
    met = _meet(
        placed.origin,
        placed.rotation,
        limits,
        hand.finger_width / 2,
        hand.finger_thickness,
        np.ascontiguousarray(surface.T),
    )
    sunk = met[:, :2].clip(0.0, hand.finger_length)
    return Unseen(sunk.max(axis=1), sunk.min(axis=1), met[:, 3] - met[:, 2])


@kernel
def _meet(
    origin: Array,
    rotation: Array,
    limits: Array,
    half_width: float,
    thickness: float,
    columns: Array,
) -> Array:
    """Return, for each hand, how far its left and right finger sink in, and both edges (G, 4).

    `limits` (G, 4): left and right edge of the part, half of the opening, depth of the tips;
    `columns` (3, B): the points' x, y and z.
    """
    met = np.zeros((len(origin), 4))
    px, py, pz = columns[0], columns[1], columns[2]
    for g in range(len(origin)):
        r, o = rotation[g], origin[g]
        left, right, inner, tip = limits[g]
        middle = (left + right) / 2
        met[g, 2], met[g, 3] = left, right
        for n in range(len(px)):
            dx, dy, dz = px[n] - o[0], py[n] - o[1], pz[n] - o[2]
            x = r[0, 0] * dx + r[1, 0] * dy + r[2, 0] * dz
            z = r[0, 2] * dx + r[1, 2] * dy + r[2, 2] * dz
            if abs(x) > half_width or z > tip:
                continue
            y = r[0, 1] * dx + r[1, 1] * dy + r[2, 1] * dz
            off = abs(y - middle)
            if off > inner + thickness:
                continue
            met[g, 2], met[g, 3] = min(met[g, 2], y), max(met[g, 3], y)
            if off > inner:
                side = 0 if y < middle else 1
                met[g, side] = max(met[g, side], tip - z)
    return met
