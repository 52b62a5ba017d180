"""The stage: an object in its surroundings in, collision-free grasps out."""

from __future__ import annotations

from collections import Counter

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.boxes import support_clearance, touches_obstacle
from services.grasp_proposal.contacts import Contacts, find_contacts
from services.grasp_proposal.diversity import Likeness, distinct
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.orientations import hypothesise
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.scorer import promise, score, tool_centre
from services.grasp_proposal.search import search
from services.grasp_proposal.settings import GraspProposalSettings
from services.grasp_proposal.surface import local_frames
from services.grasp_proposal.visibility import SightMap
from services.grasp_proposal.workspace import Workspace, build_workspace
from shared.errors import UnknownGripper
from shared.geometry.rotation import quaternion_from_matrix
from shared.geometry.se3 import transform_points
from shared.grippers import choose_gripper, load_grippers
from shared.schemas.grasp import ProposeRequest, ProposeResponse
from shared.schemas.gripper import GripperList, SuctionGripper
from shared.schemas.route import Nothing
from shared.schemas.scene import SupportPlane

Array = NDArray[np.float64]

_LOOK_CLOSER = 320
_UNLIKE = Likeness(distance=0.006, angle_deg=12.0)
_LEAST_ALIGNMENT = 0.5
_TOUCHES = 0.8


class GraspProposer:
    """Proposes grasps; holds nothing but settings and grippers, so calls may overlap."""

    def __init__(self, settings: GraspProposalSettings) -> None:
        self._settings = settings
        self._grippers = load_grippers(settings.grippers_dir)

    def list_grippers(self, _: Nothing) -> GripperList:
        """Return the known grippers, in alphabetical order."""
        return GripperList(grippers=tuple(self._grippers.values()))

    def warm_up(self) -> None:
        """Run everything once, on a small post beside an obstacle: compiles what is not cached."""
        turn, height = (
            a.ravel() for a in np.meshgrid(np.arange(0, 3, 0.1), np.arange(0, 0.1, 0.004))
        )
        post = np.column_stack([-0.02 * np.sin(turn), 0.02 * np.cos(turn), height])
        plane = SupportPlane(normal=(0.0, 0.0, 1.0), offset=0.0, inliers=0, residual_mm=0.0)
        self.propose(
            ProposeRequest(
                points=post,
                obstacle_points=post + np.array([0.1, 0.3, 0.0]),
                plane=plane,
                viewpoint=(-0.5, 0.0, 0.5),
                samples=20,
            )
        )

    def propose(self, request: ProposeRequest) -> ProposeResponse:
        """Return collision-free grasps, best first.

        Raises
        ------
        UnknownGripper, EmptyCloud, InvalidInput
            See `choose_gripper` and `build_workspace`.
        """
        gripper = choose_gripper(self._grippers, request.gripper)
        if isinstance(gripper, SuctionGripper):
            raise UnknownGripper(
                f"no grasps are proposed for the suction gripper {gripper.name!r} yet",
                field="gripper",
                found=gripper.name,
            )
        hand = Hand.of(gripper, self._settings)
        workspace = build_workspace(request)
        rejected: Counter[str] = Counter()
        rng = np.random.default_rng(request.seed)
        placed = _candidates(workspace, hand, request.samples, rng, rejected)
        rows, on_focus = self._judge(workspace, hand, placed, rejected)
        left_out = {reason: count for reason, count in sorted(rejected.items()) if count}
        return ProposeResponse(
            grasps=rows,
            on_focus=on_focus,
            considered=len(rows) + sum(left_out.values()),
            rejected=left_out,
        )

    def _judge(
        self, workspace: Workspace, hand: Hand, placed: Placements, rejected: Counter[str]
    ) -> tuple[Array, Array]:
        """Return grasp rows (G, 9) in the request's frame, and what they hold in focus (G, 3)."""
        if not len(placed):
            return np.empty((0, 9)), np.empty((0, 3))
        contacts = find_contacts(workspace, hand, placed)
        tips, palm = support_clearance(contacts.placed, hand, contacts.opening, workspace)
        failures = {
            "no_contact": contacts.empty,
            "too_wide": contacts.width > hand.max_width,
            "collision_object": contacts.finger_hit | contacts.palm_hit,
            "collision_support": (tips < _TOUCHES * hand.support_clearance)
            | (palm < hand.palm_clearance),
            "not_antipodal": contacts.sloped | (contacts.alignment < _LEAST_ALIGNMENT),
        }
        good = np.ones(len(placed), dtype=np.bool_)
        for reason, failed in failures.items():
            rejected[reason] += int((good & failed).sum())
            good &= ~failed
        if len(workspace.obstacles):
            rows = np.flatnonzero(good)
            hit = touches_obstacle(
                contacts.placed.take(rows), hand, contacts.opening[rows], workspace.obstacles
            )
            rejected["collision_obstacle"] += int(hit.sum())
            good[rows[hit]] = False
        sight = None
        if workspace.viewpoint is not None:
            sight = SightMap.of(workspace.points, workspace.viewpoint)
        scores = np.where(good, score(workspace, hand, contacts, palm, sight), -1.0)
        order = np.argsort(-scores, kind="stable")[: int(good.sum())]
        return self._rows(workspace, hand, contacts, scores, order, rejected)

    def _rows(
        self,
        workspace: Workspace,
        hand: Hand,
        contacts: Contacts,
        scores: Array,
        order: NDArray[np.intp],
        rejected: Counter[str],
    ) -> tuple[Array, Array]:
        centres = tool_centre(contacts.placed, hand)[order]
        rotations = upright(contacts.placed.rotation[order])
        kept = distinct(centres, rotations, self._settings.max_grasps)
        rejected["duplicate"] += len(order) - len(kept)
        motion = workspace.outer_from_work
        rows = np.column_stack(
            [
                transform_points(motion, centres[kept]),
                quaternion_from_matrix(motion[:3, :3] @ rotations[kept]).reshape(-1, 4),
                contacts.width[order][kept],
                scores[order][kept],
            ]
        )
        shares = np.column_stack(
            [contacts.in_focus, contacts.left_in_focus, contacts.right_in_focus]
        )
        return rows, shares[order][kept]


def upright(rotations: Array) -> Array:
    """Return rotations (G, 3, 3) turned by half a turn about z where y points to -y.

    A parallel gripper does not know its left finger from its right.
    """
    flip = (rotations[:, 1, 1] < 0) | ((rotations[:, 1, 1] == 0) & (rotations[:, 0, 1] < 0))
    sign = np.where(flip, -1.0, 1.0)[:, None]
    return np.stack(
        [rotations[:, :, 0] * sign, rotations[:, :, 1] * sign, rotations[:, :, 2]], axis=2
    )


def _candidates(
    workspace: Workspace,
    hand: Hand,
    samples: int,
    rng: np.random.Generator,
    rejected: Counter[str],
) -> Placements:
    """Search around sampled points and keep the most promising hands for a closer look."""
    wanted = np.nonzero(workspace.in_focus)[0]
    if len(wanted) > samples:
        wanted = np.sort(rng.choice(wanted, samples, replace=False))
    points = workspace.points[wanted]
    frames = local_frames(
        points, workspace.normals[wanted], workspace.coarse, workspace.coarse_normals
    )
    hands = hypothesise(frames, workspace.up, workspace.viewpoint)
    placed = search(workspace, hand, points, hands, rejected)
    opening = np.minimum(placed.right - placed.left + 2 * hand.clearance, hand.max_opening)
    tips, palm = support_clearance(placed, hand, opening, workspace)
    low = (tips < _TOUCHES * hand.support_clearance) | (palm < hand.palm_clearance)
    rejected["collision_support"] += int(low.sum())
    placed = placed.take(~low)
    if len(placed) <= _LOOK_CLOSER:
        return placed
    order = np.argsort(-promise(workspace, hand, placed), kind="stable")
    centres, rotations = tool_centre(placed, hand)[order], placed.rotation[order]
    kept = order[distinct(centres, rotations, _LOOK_CLOSER, _UNLIKE)]
    rejected["less_promising"] += len(order) - len(kept)
    return placed.take(np.sort(kept))
