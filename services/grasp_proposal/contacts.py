"""Where the pads will touch: exact edges of the part, and how well they oppose each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.boxes import finger_hits, palm_hits
from services.grasp_proposal.closer_look import look_closer
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.side import touch_side
from services.grasp_proposal.workspace import Workspace
from shared.geometry.rotation import unit

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_MAX_HIDDEN = 0.4
_LEAST_POINTS = 3


@dataclass(frozen=True)
class Contacts:
    """How each of G placed hands would touch the part.

    Attributes
    ----------
    placed : Placements
        With exact edges; the hidden share is part of `left` and `right`.
    width, opening : (G,) arrays
        Of the part between the pads, and between the pads on the way in.
    hidden : (G,) array
        How much of `width` is a guess about the side that was not seen.
    alignment : (G,) array
        Cosine between the closing direction and the worse contact normal.
    sloped : (G,) bool array
        The pads would close on a slope or a corner that goes on beyond them,
        outside the friction cone: they would squeeze the part away.
    coverage : (G,) array
        Share of the pads' width that has surface at its edge, on the worse side.
    twist : (G,) array
        How far left and right contacts lie apart along x, metres.
    engagement : (G,) array
        How far the tips reach past the part's front, metres.
    in_focus : (G,) array
        Share of the enclosed points where a grasp is wanted.
    left_in_focus, right_in_focus : (G,) arrays
        The same of the points that each pad touches.
    finger_hit, palm_hit, empty : (G,) bool arrays
        Touches the object on the way; holds nothing.
    """

    placed: Placements
    width: Array
    opening: Array
    hidden: Array
    alignment: Array
    sloped: Mask
    coverage: Array
    twist: Array
    engagement: Array
    in_focus: Array
    left_in_focus: Array
    right_in_focus: Array
    finger_hit: Mask
    palm_hit: Mask
    empty: Mask

    def take(self, chosen: NDArray[np.intp] | Mask) -> Contacts:
        """Return the chosen rows."""
        held = {each.name: getattr(self, each.name) for each in fields(self)}
        placed = held.pop("placed").take(chosen)
        return Contacts(placed, **{name: values[chosen] for name, values in held.items()})


def concatenated(several: Sequence[Contacts]) -> Contacts:
    """Return the rows of several, one after the other."""
    names = [each.name for each in fields(Contacts) if each.name != "placed"]
    return Contacts(
        Placements.concatenated([each.placed for each in several]),
        **{name: np.concatenate([getattr(each, name) for each in several]) for name in names},
    )


def find_contacts(workspace: Workspace, hand: Hand, placed: Placements) -> Contacts:
    """Look at each placed hand with the whole cloud."""
    seen = look_closer(
        workspace.points,
        workspace.normals,
        workspace.in_focus,
        placed.origin,
        placed.rotation,
        np.column_stack([placed.tip, placed.left, placed.right]),
        hand.finger_width,
    )
    closing = placed.rotation[:, :, 1]
    left_side = touch_side(workspace, closing, seen.left_pad, -1)
    right_side = touch_side(workspace, closing, seen.right_pad, +1)
    left_hidden, right_hidden = _hidden_flanks(workspace, placed, seen.right - seen.left, hand)
    exact = replace(
        placed, left=seen.left - left_hidden, right=seen.right + right_hidden, front=seen.front
    )
    width = exact.right - exact.left
    opening = np.minimum(width + 2 * hand.clearance, hand.max_opening)
    return Contacts(
        placed=exact,
        width=width,
        opening=opening,
        hidden=left_hidden + right_hidden,
        alignment=np.minimum(left_side.alignment, right_side.alignment),
        sloped=left_side.sloped | right_side.sloped,
        coverage=np.minimum(left_side.coverage, right_side.coverage),
        twist=np.abs(left_side.x - right_side.x),
        engagement=placed.tip - seen.front,
        in_focus=seen.in_focus / np.maximum(seen.number, 1),
        left_in_focus=left_side.in_focus,
        right_in_focus=right_side.in_focus,
        finger_hit=finger_hits(exact, hand, opening, workspace.solid),
        palm_hit=palm_hits(exact, hand, workspace.points),
        empty=seen.number < _LEAST_POINTS,
    )


def _hidden_flanks(
    workspace: Workspace, placed: Placements, width: Array, hand: Hand
) -> tuple[Array, Array]:
    """Return how far the part may reach beyond its visible edges, left and right (G,).

    Seen at an angle a to the approach, a round part shows r (1 + cos a) of its
    2 r across the closing direction; the rest is behind the far edge. A box seen
    so hides nothing: the guess is on the safe side.
    """
    if workspace.viewpoint is None:
        return np.zeros(len(placed)), np.zeros(len(placed))
    sight = unit(placed.origin - workspace.viewpoint)
    across = np.einsum("gi,gi->g", sight, placed.rotation[:, :, 1])
    along = np.einsum("gi,gi->g", sight, placed.rotation[:, :, 2])
    cos = along / np.maximum(np.hypot(across, along), 1e-9)
    ratio = np.minimum((1 - cos) / np.maximum(1 + cos, 1e-3), _MAX_HIDDEN)
    spare = np.maximum(hand.max_width - width, 0.0)
    hidden = np.minimum(ratio * width, spare)
    return np.where(across < 0, hidden, 0.0), np.where(across > 0, hidden, 0.0)
