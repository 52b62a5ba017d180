"""Which of the placed hands would hold something and touch nothing else."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.boxes import support_clearance, touches_obstacle
from services.grasp_proposal.candidates import TOUCHES
from services.grasp_proposal.contacts import Contacts, find_contacts
from services.grasp_proposal.examples import keep_failed
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.rejections import Rejections
from services.grasp_proposal.workspace import Workspace

_LEAST_ALIGNMENT = 0.5
_LEAST_WIDTH = 0.0005
"""Metres: what is seen as thinner is one side of something, and not a part between the pads."""


def passing(workspace: Workspace, hand: Hand, placed: Placements, rejected: Rejections) -> Contacts:
    """Return the contacts of the hands that pass all checks; count the others by reason."""
    contacts = find_contacts(workspace, hand, placed)
    tips, palm = support_clearance(contacts.placed, hand, contacts.opening, workspace)
    failures = {
        "no_contact": contacts.empty | (contacts.width < _LEAST_WIDTH),
        "too_wide": contacts.width > hand.max_width,
        "collision_object": contacts.finger_hit | contacts.palm_hit,
        "collision_support": (tips < TOUCHES * hand.support_clearance)
        | (palm < hand.palm_clearance),
        "not_antipodal": contacts.sloped | (contacts.alignment < _LEAST_ALIGNMENT),
    }

    def leave_out(reason: str, failed: NDArray[np.bool_]) -> None:
        rejected.counts[reason] += int(failed.sum())
        if rejected.wanted:
            keep_failed(rejected, reason, failed, hand, placed, contacts, workspace.solid)

    good = np.ones(len(placed), dtype=np.bool_)
    for reason, failed in failures.items():
        leave_out(reason, good & failed)
        good &= ~failed
    if len(workspace.obstacles):
        rows = np.flatnonzero(good)
        hit = touches_obstacle(
            contacts.placed.take(rows), hand, contacts.opening[rows], workspace.obstacles
        )
        failed = np.zeros(len(placed), dtype=np.bool_)
        failed[rows[hit]] = True
        leave_out("collision_obstacle", failed)
        good &= ~failed
    return contacts.take(good)
