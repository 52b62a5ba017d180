"""What each factor of the score says, on hands placed by hand."""

from __future__ import annotations

import numpy as np
import pytest

from services.grasp_proposal.contacts import Contacts, find_contacts
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.scorer import factors, score, tool_centre
from services.grasp_proposal.settings import GraspProposalSettings
from services.grasp_proposal.visibility import SightMap
from services.grasp_proposal.workspace import Workspace, build_workspace
from shared.geometry.se3 import inverse, transform_points
from shared.grippers import load_grippers
from shared.schemas.gripper import ParallelGripper
from tests.services.grasp_proposal.scenes import Scene, about_z, box, lying_cylinder

PANDA = load_grippers()["panda"]
assert isinstance(PANDA, ParallelGripper)
HAND = Hand.of(PANDA, GraspProposalSettings())
DOWN = np.column_stack([[0.0, 1, 0], [1.0, 0, 0], [0.0, 0, -1]])


def from_above(
    scene: Scene, at: tuple[float, ...], turn: float, tip: float, half: float
) -> tuple[Workspace, Contacts]:
    """Place a hand over `at`, closing along x turned by `turn`, on a part 2 `half` wide."""
    workspace = build_workspace(scene.request())
    work_from_outer = inverse(workspace.outer_from_work)
    placed = Placements(
        rotation=(work_from_outer[:3, :3] @ about_z(turn) @ DOWN)[None],
        origin=transform_points(work_from_outer, np.array([at])),
        tip=np.array([tip]),
        left=np.array([-half]),
        right=np.array([half]),
        front=np.array([0.0]),
    )
    return workspace, find_contacts(workspace, HAND, placed)


def judged(workspace: Workspace, contacts: Contacts) -> dict[str, float]:
    assert workspace.viewpoint is not None
    sight = SightMap.of(workspace.points, workspace.viewpoint)
    heights = np.full(1, 0.1)
    named = factors(workspace, HAND, contacts, heights, sight)
    total = score(workspace, HAND, contacts, heights, sight)
    assert total[0] == pytest.approx(np.prod([value[0] for value in named.values()]))
    assert all(0 <= value[0] <= 1 for value in named.values())
    return {name: float(value[0]) for name, value in named.items()}


CYLINDER = lying_cylinder(radius=0.02, turn=0.0)
TOP = (0.0, 0.0, 0.04)


def test_a_centred_grasp_on_a_cylinder() -> None:
    workspace, contacts = from_above(CYLINDER, TOP, 0.0, 0.035, 0.022)
    assert contacts.width[0] == pytest.approx(0.04, abs=0.008)
    assert not contacts.finger_hit[0]
    assert not contacts.palm_hit[0]
    assert contacts.coverage[0] == 1.0
    assert contacts.engagement[0] == pytest.approx(0.035, abs=0.002)
    outer = transform_points(workspace.outer_from_work, tool_centre(contacts.placed, HAND))
    assert outer[0] == pytest.approx([0, 0, 0.04 - 0.035 + HAND.tip_beyond_tcp], abs=0.005)


def test_balance_and_hold_favour_the_middle() -> None:
    middle = judged(*from_above(CYLINDER, TOP, 0.0, 0.035, 0.022))
    end = judged(*from_above(CYLINDER, (0.0, 0.06, 0.04), 0.0, 0.035, 0.022))
    assert middle["balance"] > end["balance"]
    assert middle["hold"] > end["hold"]


def test_deeper_is_firmer() -> None:
    shallow = judged(*from_above(CYLINDER, TOP, 0.0, 0.004, 0.02))
    deep = judged(*from_above(CYLINDER, TOP, 0.0, 0.030, 0.022))
    assert deep["engaged"] > shallow["engaged"]


def test_pads_above_the_widest_place_squeeze_a_cylinder_away() -> None:
    _, high = from_above(CYLINDER, TOP, 0.0, 0.006, 0.02)
    _, low = from_above(CYLINDER, TOP, 0.0, 0.035, 0.022)
    assert high.sloped[0]
    assert not low.sloped[0]


def test_a_corner_of_a_wide_box_is_no_place_to_hold() -> None:
    size = 0.16
    scene = box((size, size, 0.06), turn=0.0)
    corner = (-size / 2 + 0.004, -size / 2 + 0.004, 0.06)
    _, contacts = from_above(scene, corner, -np.pi / 4, 0.03, 0.035)
    assert contacts.sloped[0]


def test_a_palm_or_finger_on_the_object_is_seen() -> None:
    _, too_deep = from_above(box((0.03, 0.03, 0.15)), (0.0, 0.0, 0.15), 0.3, 0.06, 0.017)
    assert too_deep.palm_hit[0]
    wide = box((0.06, 0.06, 0.10), turn=0.0)
    _, on_edge = from_above(wide, (0.0, 0.0, 0.10), 0.0, 0.03, 0.01)
    assert on_edge.finger_hit[0]


def test_an_empty_hand_is_empty() -> None:
    _, contacts = from_above(CYLINDER, (0.2, 0.0, 0.04), 0.0, 0.03, 0.02)
    assert contacts.empty[0]
