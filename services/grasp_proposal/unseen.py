"""Where the superquadrics say that the object goes on behind what the sensor saw."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.contacts import Contacts
from services.grasp_proposal.fingers import finger_samples
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.visibility import SightMap
from services.grasp_proposal.workspace import Workspace
from shared.geometry.se3 import transform_points
from shared.jit import kernel
from shared.superquadric import inside_outside

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_THROUGH, _DEEP = (0.1, 0.5, 0.9), (0.0, 0.1, 0.2, 0.35, 0.5, 0.7)
"""Samples of a finger: shares of its thickness and, from the tip, of its length."""
_LEAST = 0.003
"""By which a finger is in the way at least whose tip alone is inside, metres."""


class Unseen(NamedTuple):
    """What each of G hands would meet of the object where it was not seen.

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
    if sight is None or not workspace.bodies:
        none = np.zeros(len(contacts.width))
        return Unseen(none, none, contacts.width)
    sunk = np.stack([_sunk(workspace, hand, contacts, sight, sign) for sign in (-1.0, 1.0)])
    surface = workspace.believed
    above = workspace.heights(surface) > 0
    surface = surface[above & (sight.depth_behind(surface) > 0)]
    placed = contacts.placed
    edges = _edges(
        placed.origin,
        placed.rotation,
        np.column_stack([placed.left, placed.right, contacts.opening / 2, placed.tip]),
        hand.finger_width / 2,
        hand.finger_thickness,
        np.ascontiguousarray(surface.T),
    )
    return Unseen(sunk.max(axis=0), sunk.min(axis=0), edges[:, 1] - edges[:, 0])


def agrees_with_sight(
    workspace: Workspace, hand: Hand, contacts: Contacts, sight: SightMap | None
) -> Mask:
    """Say for which hands (G,) the superquadrics are not where the fingers are seen to have room.

    Where an open finger is inside one, in front of the surface that was seen, the object is not
    what it is taken for: a bowl's superquadric is solid, and a hand at its rim has a finger in it.
    """
    met = np.zeros(len(contacts.width), dtype=np.bool_)
    for sign in (-1.0, 1.0):
        samples, _ = finger_samples(hand, contacts, sign, _THROUGH, _DEEP)
        seen = sight is None or sight.depth_behind(samples) <= 0
        met |= (_in_bodies(workspace, samples) & seen).any(axis=1)
    return ~met


def _in_bodies(workspace: Workspace, points: Array) -> Mask:
    """Say which points (..., 3) are inside a superquadric."""
    outer = transform_points(workspace.outer_from_work, points.reshape(-1, 3))
    inside = np.zeros(len(outer), dtype=np.bool_)
    for body in workspace.bodies:
        inside |= inside_outside(body, outer) < 1
    return inside.reshape(points.shape[:-1])


def _sunk(
    workspace: Workspace, hand: Hand, contacts: Contacts, sight: SightMap, sign: float
) -> Array:
    """Return how far from its tip a finger (G,) is inside a superquadric, out of sight."""
    samples, above_tip = finger_samples(hand, contacts, sign, _THROUGH, _DEEP)
    hidden = (sight.depth_behind(samples) > 0) & (workspace.heights(samples) > 0)
    met = np.zeros(hidden.shape, dtype=np.bool_)
    met[hidden] = _in_bodies(workspace, samples[hidden])
    return np.asarray(np.where(met, _LEAST + above_tip, 0.0).max(axis=1))


@kernel
def _edges(
    origin: Array,
    rotation: Array,
    limits: Array,
    half_width: float,
    thickness: float,
    columns: Array,
) -> Array:
    """Return the left and right edge (G, 2) of what is between, or below, the fingers.

    `limits` (G, 4): left and right edge of the part, half of the opening, depth of the tips;
    `columns` (3, B): the x, y and z of points that widen it.
    """
    edges = limits[:, :2].copy()
    px, py, pz = columns[0], columns[1], columns[2]
    for g in range(len(origin)):
        r, o = rotation[g], origin[g]
        left, right, inner, tip = limits[g]
        middle = (left + right) / 2
        for n in range(len(px)):
            dx, dy, dz = px[n] - o[0], py[n] - o[1], pz[n] - o[2]
            x = r[0, 0] * dx + r[1, 0] * dy + r[2, 0] * dz
            z = r[0, 2] * dx + r[1, 2] * dy + r[2, 2] * dz
            if abs(x) > half_width or z > tip:
                continue
            y = r[0, 1] * dx + r[1, 1] * dy + r[2, 1] * dz
            if abs(y - middle) <= inner + thickness:
                edges[g, 0], edges[g, 1] = min(edges[g, 0], y), max(edges[g, 1], y)
    return edges
