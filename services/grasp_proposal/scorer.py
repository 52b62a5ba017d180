"""How good is a grasp? A geometric score in [0, 1]."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.contacts import Contacts
from services.grasp_proposal.fingers import finger_samples
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.visibility import SightMap
from services.grasp_proposal.workspace import Workspace
from shared.geometry.rotation import unit

Array = NDArray[np.float64]

_GOOD_ENGAGEMENT = 0.020
_LEVER = 0.08
_HIDDEN_THICKNESS = 0.015
FRICTION = 0.6
_THROUGH, _DEEP = (0.15, 0.85), (0.0, 0.2, 0.4, 0.6)


def score(
    workspace: Workspace, hand: Hand, contacts: Contacts, heights: Array, sight: SightMap | None
) -> Array:
    """Return the score (G,) of each grasp: the product of its `factors`."""
    parts = factors(workspace, hand, contacts, heights, sight)
    return np.asarray(np.prod(list(parts.values()), axis=0))


def factors(
    workspace: Workspace, hand: Hand, contacts: Contacts, heights: Array, sight: SightMap | None
) -> dict[str, Array]:
    """Return what makes each grasp hold or fail, each (G,) in [0, 1], by name.

    Parameters
    ----------
    heights : (G,) array
        Of the palm above the support, from `support_clearance`.
    sight : SightMap or None
        Without it, all space but the points counts as free.
    """
    placed = contacts.placed
    return {
        "antipodal": _ramp(contacts.alignment, 0.35, 0.95),
        "coverage": 0.1 + 0.9 * contacts.coverage,
        "opposed": 1 - 0.5 * np.clip(contacts.twist / (hand.finger_width / 2), 0, 1),
        "engaged": _ramp(contacts.engagement, -0.006, _GOOD_ENGAGEMENT),
        "seen": 1 - 0.6 * contacts.hidden / np.maximum(contacts.width, 1e-4),
        "opening": 0.6 + 0.4 * _ramp(hand.max_opening - contacts.width, 0, 0.25 * hand.max_opening),
        "palm_clear": 0.7 + 0.3 * _ramp(heights, 0, 0.02),
        "in_focus": 0.2 + 0.8 * contacts.in_focus,
        "balance": _balance(workspace, placed, hand),
        "hold": _hold(workspace, hand, contacts),
        "reach": _reach(workspace, placed),
        "free": _free_fingers(contacts, hand, workspace, sight),
    }


def promise(workspace: Workspace, hand: Hand, placed: Placements) -> Array:
    """Return the part of the score (G,) that is known before looking at the contacts."""
    width = placed.right - placed.left
    return (
        _ramp(placed.tip - placed.front, -0.006, _GOOD_ENGAGEMENT)
        * (1 - 0.4 * width / hand.max_opening)
        * _balance(workspace, placed, hand)
        * _reach(workspace, placed)
    )


def tool_centre(placed: Placements, hand: Hand) -> Array:
    """Return the tool centre points (G, 3)."""
    y = (placed.left + placed.right) / 2
    z = placed.tip - hand.tip_beyond_tcp
    return np.asarray(
        placed.origin
        + placed.rotation[:, :, 1] * y[:, None]
        + placed.rotation[:, :, 2] * z[:, None]
    )


def _balance(workspace: Workspace, placed: Placements, hand: Hand) -> Array:
    """Gravity's lever about the pads: level distance to the centre of mass."""
    lever = workspace.centre_of_mass - tool_centre(placed, hand)
    if workspace.up is not None:
        lever = lever - (lever @ workspace.up)[:, None] * workspace.up
    return np.asarray(0.3 + 0.7 * np.exp(-0.5 * (np.linalg.norm(lever, axis=1) / _LEVER) ** 2))


def _hold(workspace: Workspace, hand: Hand, contacts: Contacts) -> Array:
    """Return how well the pads resist the torque of the weight about the axes of the hand.

    About the closing axis friction over the contact patch resists, about the
    other two the couple of normal forces over the patch's height and width.
    """
    if workspace.up is None:
        return np.ones(len(contacts.width))
    rotation = contacts.placed.rotation
    lever = workspace.centre_of_mass - tool_centre(contacts.placed, hand)
    torque = np.cross(lever, -workspace.up * workspace.weight)
    torque = np.abs(np.einsum("gi,gij->gj", torque, rotation))
    high = np.clip(contacts.engagement, 0.002, hand.finger_length) / 2
    wide = np.clip(contacts.coverage, 0.1, 1.0) * hand.finger_width / 2
    capacity = hand.force * np.stack(
        [high, 2 * FRICTION * np.hypot(high, wide) * 0.66, wide], axis=1
    )
    load = torque / capacity
    return np.asarray(1 / (1 + load[:, 0] ** 2 + 0.25 * load[:, 1] ** 2 + load[:, 2] ** 2))


def _reach(workspace: Workspace, placed: Placements) -> Array:
    """Come from above or from the sensor's side, close level: where an arm can be."""
    rotation = placed.rotation
    factor = np.ones(len(placed))
    if workspace.up is not None:
        factor = factor * (1 - 0.8 * (rotation[:, :, 1] @ workspace.up) ** 2)
        factor = factor * (0.8 + 0.2 * _ramp(-rotation[:, :, 2] @ workspace.up, -0.3, 0.7))
    if workspace.viewpoint is not None:
        sight = unit(placed.origin - workspace.viewpoint)
        facing = np.einsum("gi,gi->g", sight, rotation[:, :, 2])
        factor = factor * (0.3 + 0.7 * _ramp(facing, -0.3, 0.4))
    return np.asarray(factor)


def _free_fingers(
    contacts: Contacts, hand: Hand, workspace: Workspace, sight: SightMap | None
) -> Array:
    """Chance that the fingers meet nothing in space that was not seen.

    Hidden space next to the visible surface is likely full, further behind it
    likely empty: exp(-depth / 15 mm).
    """
    if sight is None:
        return np.ones(len(contacts.width))
    worst = np.zeros(len(contacts.width))
    for sign in (-1.0, 1.0):
        samples, _ = finger_samples(hand, contacts, sign, _THROUGH, _DEEP)
        behind = sight.depth_behind(samples)
        above = workspace.heights(samples) > 0
        full = np.where((behind > 0) & above, np.exp(-behind / _HIDDEN_THICKNESS), 0.0)
        worst = np.maximum(worst, full.mean(axis=1))
    return 1 - 0.8 * np.clip(2 * worst, 0, 1)


def _ramp(value: Array, low: float, high: float) -> Array:
    """Return 0 below `low`, 1 above `high`, linear between."""
    return np.clip((value - low) / (high - low), 0.0, 1.0)
