"""Which grasps are worth a rehearsal: it is in doubt whether they hold, and it can be told."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.contacts import Contacts
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.scorer import FRICTION, tool_centre
from services.grasp_proposal.unseen import agrees_with_sight
from services.grasp_proposal.visibility import SightMap
from services.grasp_proposal.workspace import Workspace

Array = NDArray[np.float64]

SURE = 0.9
"""A grasp of a lower score is in doubt."""


def doubtful(
    workspace: Workspace, hand: Hand, contacts: Contacts, scores: Array, sight: SightMap | None
) -> NDArray[np.bool_]:
    """Say which grasps (G,) a simulation on the superquadrics would tell something about.

    Those of a low score, and those whose object turns between the pads, which the scorer has
    seen too little of; but not where the superquadrics are not what was seen.
    """
    turns = load(workspace, hand, tool_centre(contacts.placed, hand)) > 1
    unsure = np.asarray((scores < SURE) | turns)
    some = np.flatnonzero(unsure)
    unsure[some] = agrees_with_sight(workspace, hand, contacts.take(some), sight)
    return unsure


def load(workspace: Workspace, hand: Hand, centres: Array) -> Array:
    """Return the torque of the guessed weight (G,) over what the pads resist by friction.

    About tool centre points (G, 3), with the whole distance to the centre of mass as its lever:
    a hand that turns the object about will come to where that is level. A pad resists as a
    disc of the finger's width under even pressure, by 2/3 of friction times force times
    radius. Above 1 the object turns between the pads, and hangs or swings.
    """
    lever = np.linalg.norm(workspace.centre_of_mass - centres, axis=1)
    resisted = 2 * (2 / 3) * FRICTION * hand.force * hand.finger_width / 2
    return np.asarray(workspace.weight * lever / resisted)
