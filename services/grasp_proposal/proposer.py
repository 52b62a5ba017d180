"""The stage: an object in its surroundings in, collision-free grasps out."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from services.grasp_proposal.boxes import comes_near, support_clearance
from services.grasp_proposal.candidates import candidates
from services.grasp_proposal.closing_region import upright
from services.grasp_proposal.contacts import Contacts, concatenated
from services.grasp_proposal.cup import Cup
from services.grasp_proposal.diversity import distinct
from services.grasp_proposal.doubt import doubtful
from services.grasp_proposal.examples import keep_unlike
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.learned import LearnedScorer
from services.grasp_proposal.passing import passing
from services.grasp_proposal.rejections import Rejections
from services.grasp_proposal.scorer import tool_centre
from services.grasp_proposal.settings import GraspProposalSettings
from services.grasp_proposal.suction import propose_suction
from services.grasp_proposal.visibility import SightMap
from services.grasp_proposal.workspace import Workspace, build_workspace
from shared.deadline import check_deadline
from shared.geometry.rotation import quaternion_from_matrix
from shared.geometry.se3 import transform_points
from shared.grippers import choose_gripper, load_grippers
from shared.schemas.grasp import ProposeRequest, ProposeResponse
from shared.schemas.gripper import GripperList, SuctionGripper
from shared.schemas.route import Nothing
from shared.schemas.scene import SupportPlane

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_ENOUGH = 16
_AWAY = 0.010
_MORE_TURNS_DEG = (20.0, -20.0)


class GraspProposer:
    """Proposes grasps; holds settings, grippers and a network alone, so calls may overlap."""

    def __init__(self, settings: GraspProposalSettings) -> None:
        self._settings = settings
        self._grippers = load_grippers(settings.grippers_dir)
        self._scorer = LearnedScorer()

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
        body = np.array([[0.1, 1.0, 0.02, 0.02, 0.05, 0.0, 0.0, 0.05, 0.0, 0.0, 0.0, 1.0]])
        kinds = {gripper.kind: name for name, gripper in self._grippers.items()}
        for name in kinds.values():
            request = ProposeRequest(
                points=post,
                obstacle_points=post + np.array([0.1, 0.3, 0.0]),
                plane=plane,
                viewpoint=(-0.5, 0.0, 0.5),
                superquadrics=body,
                samples=20,
                gripper=name,
            )
            self.propose(request)

    def propose(self, request: ProposeRequest) -> ProposeResponse:
        """Return collision-free grasps, best first.

        Raises
        ------
        UnknownGripper, EmptyCloud, InvalidInput
            See `choose_gripper` and `build_workspace`.
        """
        gripper = choose_gripper(self._grippers, request.gripper)
        workspace = build_workspace(request)
        check_deadline()
        rejected = Rejections(request.rejected, request.seed)
        rng = np.random.default_rng(request.seed)
        if isinstance(gripper, SuctionGripper):
            cup = Cup.of(gripper, self._settings)
            limit = self._settings.max_grasps
            cups = propose_suction(workspace, cup, request.samples, rng, rejected, limit)
            closed = np.zeros(len(cups.scores))
            rows = _rows(workspace, cups.centres, cups.rotations, closed, cups.scores)
            on_focus = np.tile(cups.in_focus[:, None], 3)
            clear = np.ones(len(rows), dtype=np.bool_)
            unsure = ~clear
        else:
            hand = Hand.of(gripper, self._settings)
            contacts = _seek(workspace, hand, request.samples, rng, rejected)
            rows, on_focus, clear, unsure = self._answer(workspace, hand, contacts, rejected)
        left_out = {reason: count for reason, count in sorted(rejected.counts.items()) if count}
        return ProposeResponse(
            grasps=rows,
            on_focus=on_focus,
            keeps_clear=clear,
            doubtful=unsure,
            considered=len(rows) + sum(left_out.values()),
            rejected=left_out,
            **_examples(workspace, rejected),
        )

    def _answer(
        self, workspace: Workspace, hand: Hand, contacts: Contacts, rejected: Rejections
    ) -> tuple[Array, Array, Mask, Mask]:
        """Return grasps (G, 9), what they hold in focus (G, 3), which keep clear, are doubtful."""
        if not len(contacts.width):
            none = np.empty(0, dtype=np.bool_)
            return np.empty((0, 9)), np.empty((0, 3)), none, none
        check_deadline()
        tips, palm = support_clearance(contacts.placed, hand, contacts.opening, workspace)
        sight = None
        if workspace.viewpoint is not None:
            sight = SightMap.of(workspace.points, workspace.viewpoint)
        scores = self._scorer.score(workspace, hand, contacts, palm, tips, sight)
        order = np.argsort(-scores, kind="stable")
        contacts = contacts.take(order)
        rotations = upright(contacts.placed.rotation)
        centres = tool_centre(contacts.placed, hand)
        limit = self._settings.max_grasps
        kept = distinct(centres, rotations, limit)
        rejected.counts["duplicate"] += len(order) - len(kept)
        if rejected.wanted:
            every = np.arange(len(order))
            keep_unlike(rejected, hand, contacts.placed, every, kept, limit)
        contacts = contacts.take(kept)
        rows = _rows(workspace, centres[kept], rotations[kept], contacts.width, scores[order][kept])
        shares = [contacts.in_focus, contacts.left_in_focus, contacts.right_in_focus]
        rest = _beyond(workspace, hand.finger_width)
        near = comes_near(contacts.placed, hand, contacts.opening, rest, _AWAY)
        unsure = doubtful(workspace, hand, contacts, rows[:, -1], sight)
        return rows, np.column_stack(shares), ~near, unsure


def _rows(
    workspace: Workspace, centres: Array, rotations: Array, widths: Array, scores: Array
) -> Array:
    """Return grasp rows (G, 9) in the request's frame."""
    motion = workspace.outer_from_work
    return np.column_stack(
        [
            transform_points(motion, centres),
            quaternion_from_matrix(motion[:3, :3] @ rotations).reshape(-1, 4),
            widths,
            scores,
        ]
    )


def _beyond(workspace: Workspace, margin: float) -> Array:
    """Return the object's points (N, 3) that are farther from the focus than a margin.

    What is nearer is beside the part that is to be held, and so beside every hand that does.
    """
    rest = workspace.points[~workspace.in_focus]
    if not len(rest):
        return rest
    tree = cKDTree(workspace.points[workspace.in_focus], leafsize=64, balanced_tree=False)
    distance, _ = tree.query(rest, distance_upper_bound=margin)
    return np.asarray(rest[np.isinf(distance)])


def _examples(workspace: Workspace, rejected: Rejections) -> dict[str, Any]:
    """Return the answer's fields about hand poses that were left out, where some are wanted."""
    if not rejected.wanted:
        return {}
    poses, reasons = rejected.examples()
    rotations = upright(poses.rotations)
    rows = _rows(workspace, poses.centres, rotations, poses.widths, np.zeros(len(reasons)))
    return {"rejected_poses": rows[:, :-1], "rejected_reasons": reasons}


def _seek(
    workspace: Workspace,
    hand: Hand,
    samples: int,
    rng: np.random.Generator,
    rejected: Rejections,
) -> Contacts:
    """Return the hands that pass; while they are few, from more samples and turns."""
    found = [
        passing(workspace, hand, candidates(workspace, hand, samples, rng, rejected), rejected)
    ]
    for turn_deg in _MORE_TURNS_DEG:
        if sum(len(contacts.width) for contacts in found) >= _ENOUGH:
            break
        check_deadline()
        placed = candidates(workspace, hand, -(-samples // 2), rng, rejected, turn_deg)
        found.append(passing(workspace, hand, placed, rejected))
    return concatenated(found)
