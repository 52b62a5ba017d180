"""Which grasps are worth a rehearsal."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from services.grasp_proposal.contacts import Contacts, find_contacts
from services.grasp_proposal.doubt import SURE, doubtful, load
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.settings import GraspProposalSettings
from services.grasp_proposal.unseen import agrees_with_sight
from services.grasp_proposal.visibility import SightMap
from services.grasp_proposal.workspace import Workspace, build_workspace
from shared.grippers import load_grippers
from shared.schemas.gripper import ParallelGripper
from tests.services.grasp_proposal.scenes import lying_cylinder

Array = NDArray[np.float64]

BAR = lying_cylinder(0.015, turn=0.0)
ALONG_Y = (-np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5))
"""A quaternion: z of the superquadric along y."""
DOWN = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
"""The hand's x along the bar's axis, closing across it, from above."""
SLIM = np.array([0.1, 1.0, 0.015, 0.015, 0.08, 0, 0, 0.015, *ALONG_Y])
PANDA = load_grippers(None)["panda"]
assert isinstance(PANDA, ParallelGripper)
HAND = Hand.of(PANDA, GraspProposalSettings())


def hands(along: float, *bodies: Array) -> tuple[Workspace, Contacts, SightMap]:
    """Return a hand at a place of the bar, which lies along y, and what it is in."""
    work = build_workspace(BAR.request(superquadrics=np.array(bodies).reshape(-1, 12)))
    motion = np.linalg.inv(work.outer_from_work)
    origin = motion[:3, :3] @ np.array([0.0, along, 0.015]) + motion[:3, 3]
    placed = Placements(
        rotation=np.ascontiguousarray(motion[:3, :3] @ DOWN)[None],
        origin=origin[None],
        tip=np.array([HAND.tip_beyond_tcp]),
        left=np.array([-0.015]),
        right=np.array([0.015]),
        front=np.zeros(1),
    )
    assert work.viewpoint is not None
    return work, find_contacts(work, HAND, placed), SightMap.of(work.points, work.viewpoint)


def test_the_load_is_the_weights_torque_over_what_two_discs_resist() -> None:
    radius = (1e-3 * 3 / 4 / np.pi) ** (1 / 3)
    work, _, _ = hands(0.0, np.array([1, 1, radius, radius, radius, 0, 0, 0.1, 0, 0, 0, 1]))
    centres = work.centre_of_mass + np.array([[0.1, 0.0, 0.0], [0.0, 0.0, -0.2]])
    torque = 0.4 * 9.81 * np.array([0.1, 0.2])  # 1 dm3 weighs 400 g
    rings = np.linspace(0, HAND.finger_width / 2, 100_001)
    pressure = HAND.force / (np.pi * (HAND.finger_width / 2) ** 2)
    resisted = 2 * np.trapezoid(0.6 * pressure * rings * 2 * np.pi * rings, rings)
    np.testing.assert_allclose(load(work, HAND, centres), torque / resisted, rtol=1e-3)


@pytest.mark.parametrize(
    ("score", "along", "expected"),
    [(SURE + 0.01, 0.0, False), (SURE - 0.01, 0.0, True), (0.999, 0.07, True)],
)
def test_in_doubt_is_a_low_score_and_what_turns(score: float, along: float, expected: bool) -> None:
    heavy = np.array([0.1, 1.0, 0.06, 0.06, 0.04, 0, -0.08, 0.04, 0, 0, 0, 1])
    bodies = (SLIM, heavy) if along else (SLIM,)
    work, contacts, sight = hands(along, *bodies)
    assert doubtful(work, HAND, contacts, np.array([score]), sight).tolist() == [expected]


def test_superquadrics_where_fingers_are_seen_to_have_room_tell_nothing() -> None:
    thick = SLIM.copy()
    thick[2:4] = 0.03, 0.03  # the fingers would be in it, on the side of the sensor, too
    for bodies, agrees in (((SLIM,), True), ((thick,), False), ((SLIM, thick), False), ((), True)):
        work, contacts, sight = hands(0.0, *bodies)
        assert agrees_with_sight(work, HAND, contacts, sight).tolist() == [agrees]
        low = np.array([0.5])
        assert doubtful(work, HAND, contacts, low, sight).tolist() == [agrees]


def test_what_may_be_behind_the_surface_tells() -> None:
    """The sensor is at -x and above: a low foot towards +x would be in the bar's shadow."""
    foot = np.array([0.1, 0.1, 0.021, 0.0055, 0.08, 0.006, 0, 0.0055, *ALONG_Y])
    work, contacts, sight = hands(0.0, SLIM, foot)
    assert agrees_with_sight(work, HAND, contacts, sight).all()
    assert not agrees_with_sight(work, HAND, contacts, None).any(), "all space counts as seen"
