"""Examples of parallel grippers' hand poses that are left out, step by step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.boxes import finger_hits, palm_hits
from services.grasp_proposal.contacts import Contacts
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.rejections import HandPoses, Rejections
from services.grasp_proposal.scorer import tool_centre
from shared.schemas.rejection import RejectionCode

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Rows = NDArray[np.intp]

_BY_REASON: dict[str, RejectionCode] = {
    "too_wide": "too_wide",
    "collision_support": "support_plane",
    "not_antipodal": "not_antipodal",
    "collision_obstacle": "obstacle",
}


def hand_poses(placed: Placements, hand: Hand, widths: Array) -> HandPoses:
    """Return where hands are, their widths beside them."""
    return HandPoses(tool_centre(placed, hand), placed.rotation, widths)


def keep_placed(rejected: Rejections, code: RejectionCode, hand: Hand, placed: Placements) -> None:
    """Take hands whose part is known from the search as examples of `code`."""
    rejected.keep(code, hand_poses(placed, hand, placed.right - placed.left))


def keep_unplaced(
    rejected: Rejections, code: RejectionCode, hand: Hand, rotation: Array, at: Array, tip: Array
) -> None:
    """Take wide open hands, whose part has no known edges, as examples of `code`."""
    none = np.zeros(len(tip))
    placed = Placements(rotation, at, tip, none, none, none)
    rejected.keep(code, hand_poses(placed, hand, np.full(len(tip), hand.max_opening)))


def keep_colliding(
    rejected: Rejections, hand: Hand, placed: Placements, opening: Array, points: Array
) -> None:
    """Take hands that hit the object (N, 3) as examples of the way in which they do."""
    there = replace(hand, pregrasp=0.0)
    fingers = finger_hits(placed, there, opening, points)
    palm = palm_hits(placed, there, points) & ~fingers
    codes: tuple[tuple[RejectionCode, Mask], ...] = (
        ("finger_collides_object", fingers),
        ("palm_collides_object", palm),
        ("sweep_collides", ~fingers & ~palm),
    )
    for code, which in codes:
        keep_placed(rejected, code, hand, placed.take(which))


def keep_failed(
    rejected: Rejections,
    reason: str,
    failed: Mask,
    hand: Hand,
    placed: Placements,
    contacts: Contacts,
    points: Array,
) -> None:
    """Take some of the hands that failed a check of `passing` as examples.

    Where nothing is between the pads, `placed` says where they are, as the search left them.
    """
    rows = rejected.some(failed)
    if reason == "no_contact":
        keep_placed(rejected, "no_contact", hand, placed.take(rows))
    elif reason == "collision_object":
        opening = contacts.opening[rows]
        keep_colliding(rejected, hand, contacts.placed.take(rows), opening, points)
    else:
        keep_placed(rejected, _BY_REASON[reason], hand, contacts.placed.take(rows))


def keep_unlike(
    rejected: Rejections, hand: Hand, placed: Placements, order: Rows, kept: Rows, limit: int
) -> None:
    """Take hands that `distinct` left out as examples; see `left_out_as_alike`."""
    for code, rows in left_out_as_alike(order, kept, limit):
        keep_placed(rejected, code, hand, placed.take(rejected.some(rows)))


def left_out_as_alike(
    order: Rows, kept: Rows, limit: int
) -> tuple[tuple[RejectionCode, Rows], ...]:
    """Return what `distinct` left out, by reason.

    Parameters
    ----------
    order : (G,) array
        Rows, the best first.
    kept : (K,) array
        Which places of `order` were kept, rising. Where these are `limit`, those after the
        last of them were not looked at.
    """
    left_out = np.ones(len(order), dtype=np.bool_)
    left_out[kept] = False
    alike = left_out.copy()
    if len(kept) == limit > 0:
        alike[kept[-1] + 1 :] = False
    return ("better_grasp_nearby", order[alike]), ("less_promising", order[left_out & ~alike])
