"""Numbers about a grasp that physics depends on."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from services.grasp_proposal.boxes import support_clearance
from services.grasp_proposal.contacts import find_contacts
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.measures import NAMES, measure
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.settings import GraspProposalSettings
from services.grasp_proposal.visibility import SightMap
from services.grasp_proposal.workspace import build_workspace
from shared.grippers import load_grippers
from shared.schemas.gripper import ParallelGripper
from tests.services.grasp_proposal.scenes import lying_cylinder

Array = NDArray[np.float64]

BAR = lying_cylinder(0.015, turn=0.0)
ALONG_Y = (-np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5))
"""A quaternion: z of the superquadric along y."""
DOWN = np.array([[[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]])
"""The hand's x along the bar's axis, closing across it, from above."""


def numbers_at(along: float, *bodies: Array) -> dict[str, float]:
    """Return the numbers of a hand at a place of the bar, which lies along y."""
    gripper = load_grippers(None)["panda"]
    assert isinstance(gripper, ParallelGripper)
    hand = Hand.of(gripper, GraspProposalSettings())
    work = build_workspace(BAR.request(superquadrics=np.array(bodies) if bodies else None))
    motion = np.linalg.inv(work.outer_from_work)
    rotation = motion[:3, :3] @ DOWN
    origin = (motion[:3, :3] @ np.array([0.0, along, 0.015]) + motion[:3, 3])[None]
    placed = Placements(
        rotation=np.ascontiguousarray(rotation),
        origin=origin,
        tip=np.array([hand.tip_beyond_tcp]),
        left=np.array([-0.015]),
        right=np.array([0.015]),
        front=np.zeros(1),
    )
    contacts = find_contacts(work, hand, placed)
    tips, palm = support_clearance(contacts.placed, hand, contacts.opening, work)
    sight = SightMap.of(work.points, work.viewpoint) if work.viewpoint is not None else None
    (row,) = measure(work, hand, contacts, rotation, palm, tips, sight)
    return dict(zip(NAMES, row, strict=True))


def test_the_lever_leads_to_the_centre_of_mass() -> None:
    radius = (1e-3 * 3 / 4 / np.pi) ** (1 / 3)
    ball = np.array([1, 1, radius, radius, radius, 0.0, 0.03, 0.015, 0, 0, 0, 1])
    found = numbers_at(0.05, ball)
    assert found["lever_x"] == pytest.approx(10 * -0.02, abs=1e-6)
    assert 0.2 <= found["lever_length"] < 0.25  # and a guess about the hidden side across
    # Newtons times decimetres about the closing axis; 1 dm3 weighs 400 g.
    assert abs(found["torque_y"]) == pytest.approx(0.4 * 9.81 * 0.2, rel=1e-3)
    assert abs(found["torque_x"]) < 0.2 * abs(found["torque_y"])


def test_how_far_the_object_reaches_from_the_hand() -> None:
    length = float(np.ptp(BAR.points[:, 1]))
    middle, end = numbers_at(0.0), numbers_at(0.4 * length)
    assert middle["half_x"] == pytest.approx(10 * length / 2, rel=0.05)
    assert middle["box_x"] == pytest.approx(0.0, abs=0.05)
    assert abs(end["box_x"]) == pytest.approx(4 * length, rel=0.1)
    assert middle["farthest"] == pytest.approx(5 * length, rel=0.1)
    assert end["farthest"] == pytest.approx(9 * length, rel=0.1)


def test_what_was_not_seen_is_in_the_way() -> None:
    """The sensor is at -x and above: a low foot towards +x would be in the bar's shadow."""
    bar = np.array([0.1, 1.0, 0.015, 0.015, 0.08, 0, 0, 0.015, *ALONG_Y])
    foot = np.array([0.1, 0.1, 0.021, 0.0055, 0.08, 0.006, 0, 0.0055, *ALONG_Y])
    plain, slim, wide = numbers_at(0.0), numbers_at(0.0, bar), numbers_at(0.0, foot)
    assert plain["unseen_more"] == 0.0
    assert plain["unseen_width"] == plain["width"]
    assert slim["unseen_more"] == 0.0
    assert slim["unseen_width"] == pytest.approx(slim["width"], abs=0.06)
    assert 0.02 < wide["unseen_more"] < 0.08
    assert wide["unseen_less"] == 0.0
    assert wide["unseen_width"] > wide["width"] + 0.03
