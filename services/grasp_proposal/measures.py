"""Numbers about each grasp that the images of its closing region do not show."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.contacts import Contacts
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.scorer import factors, tool_centre
from services.grasp_proposal.unseen import meet_unseen
from services.grasp_proposal.visibility import SightMap
from services.grasp_proposal.workspace import Workspace
from shared.geometry.points import principal_axes
from shared.geometry.rotation import unit

Array = NDArray[np.float64]

_FACTORS = (
    "antipodal",
    "coverage",
    "opposed",
    "engaged",
    "seen",
    "opening",
    "palm_clear",
    "balance",
    "hold",
    "reach",
    "free",
)
"""All but whether the grasp is where one is wanted: that is no matter of physics."""
_VECTORS = ("lever", "torque", "up", "sight", "long_axis", "box", "half")
NAMES = (
    *_FACTORS,
    *(f"{name}_{axis}" for name in _VECTORS for axis in "xyz"),
    "weight",
    "lever_length",
    "farthest",
    "width",
    "width_share",
    "hidden",
    "unseen_width",
    "unseen_more",
    "unseen_less",
    "alignment",
    "twist",
    "engagement",
    "palm_height",
    "tip_height",
    "height",
    "longest",
    "middle",
    "shortest",
    "finger_width",
    "finger_length",
    "max_opening",
    "force",
)
"""Of the M numbers, in their order."""

LENGTHS = 10.0
"""What lengths are multiplied by: decimetres."""
_HIGH = 0.1
"""Heights above the support count up to here, metres."""
_ODD_X = ("lever_x", "torque_y", "torque_z", "up_x", "sight_x", "box_x")
_ODD_Y = ("lever_y", "torque_x", "torque_z", "up_y", "sight_y", "box_y")
MIRROR_X = np.array([-1.0 if name in _ODD_X else 1.0 for name in NAMES])
"""What each number is multiplied by when the scene is mirrored along the hand's x."""
MIRROR_Y = np.array([-1.0 if name in _ODD_Y else 1.0 for name in NAMES])


def measure(
    workspace: Workspace,
    hand: Hand,
    contacts: Contacts,
    rotation: Array,
    palm_height: Array,
    tip_height: Array,
    sight: SightMap | None,
) -> Array:
    """Return the numbers (G, M) of G grasps: lengths in decimetres, forces in newtons.

    Parameters
    ----------
    rotation : (G, 3, 3) array
        Of the hands, upright; vectors are in these frames.
    palm_height, tip_height : (G,) arrays
        From `support_clearance`.
    sight : SightMap or None
        Without it, all space but the points counts as free.
    """
    placed = contacts.placed
    known = factors(workspace, hand, contacts, palm_height, sight)
    centre = tool_centre(placed, hand)
    lever = workspace.centre_of_mass - centre
    up = np.zeros(3) if workspace.up is None else workspace.up
    ray = np.zeros_like(centre)
    if workspace.viewpoint is not None:
        ray = unit(centre - workspace.viewpoint)
    _, axes = principal_axes(workspace.coarse)
    extents = np.sort(np.ptp(workspace.coarse @ axes, axis=0))[::-1]
    long_axis = np.abs(np.einsum("gij,i->gj", rotation, axes[:, 0]))
    low, high, farthest = _reach_of(workspace.coarse, centre, rotation)
    vectors = [
        LENGTHS * _in_hand(rotation, lever),
        LENGTHS * _in_hand(rotation, np.cross(lever, -workspace.weight * up)),
        _in_hand(rotation, np.broadcast_to(up, centre.shape)),
        _in_hand(rotation, ray),
        long_axis,
        LENGTHS * (low + high) / 2,
        LENGTHS * (high - low) / 2,
    ]
    heights = workspace.heights(workspace.coarse)
    unseen = meet_unseen(workspace, hand, contacts, sight)
    whole = {
        "weight": workspace.weight,
        "lever_length": LENGTHS * np.linalg.norm(lever, axis=1),
        "farthest": LENGTHS * farthest,
        "width": LENGTHS * contacts.width,
        "width_share": contacts.width / hand.max_opening,
        "hidden": LENGTHS * contacts.hidden,
        "unseen_width": LENGTHS * unseen.width,
        "unseen_more": LENGTHS * unseen.more,
        "unseen_less": LENGTHS * unseen.less,
        "alignment": contacts.alignment,
        "twist": LENGTHS * contacts.twist,
        "engagement": LENGTHS * contacts.engagement,
        "palm_height": LENGTHS * np.clip(palm_height, 0, _HIGH),
        "tip_height": LENGTHS * np.clip(tip_height, 0, _HIGH),
        "height": LENGTHS * min(float(heights.max()), 1.0),
        "longest": LENGTHS * float(extents[0]),
        "middle": LENGTHS * float(extents[1]),
        "shortest": LENGTHS * float(extents[2]),
        "finger_width": LENGTHS * hand.finger_width,
        "finger_length": LENGTHS * hand.finger_length,
        "max_opening": LENGTHS * hand.max_opening,
        "force": hand.force,
    }
    columns = [known[name] for name in _FACTORS]
    columns += [vector[:, axis] for vector in vectors for axis in range(3)]
    columns += [np.broadcast_to(whole[name], len(centre)) for name in NAMES[len(columns) :]]
    return np.column_stack(columns)


def _reach_of(points: Array, centre: Array, rotation: Array) -> tuple[Array, Array, Array]:
    """Return the box of points (M, 3) in the hands' frames and their largest distance.

    Its lowest and highest corners (G, 3): how far the object reaches to either side of a
    hand, and how long it is when it hangs from there.
    """
    along = np.swapaxes(rotation, 1, 2) @ points.T
    shift = _in_hand(rotation, centre)
    squared = (points**2).sum(axis=1) - 2 * centre @ points.T + (centre**2).sum(axis=1)[:, None]
    farthest = np.sqrt(np.maximum(squared.max(axis=1), 0.0))
    return along.min(axis=2) - shift, along.max(axis=2) - shift, farthest


def _in_hand(rotation: Array, vectors: Array) -> Array:
    """Return vectors (G, 3) in the hands' frames (G, 3, 3)."""
    return np.asarray(np.einsum("gij,gi->gj", rotation, vectors))
