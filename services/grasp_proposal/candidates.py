"""Where to look closer: the most promising hands around sampled points."""

from __future__ import annotations

import numpy as np

from services.grasp_proposal.boxes import support_clearance
from services.grasp_proposal.diversity import Likeness, distinct
from services.grasp_proposal.examples import keep_placed, keep_unlike
from services.grasp_proposal.hand import Hand
from services.grasp_proposal.orientations import hypothesise
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.rejections import Rejections
from services.grasp_proposal.scorer import promise, tool_centre
from services.grasp_proposal.search import search
from services.grasp_proposal.surface import local_frames
from services.grasp_proposal.workspace import Workspace

TOUCHES = 0.8
"""Of the distance kept from the support: less counts as touching it."""
_LOOK_CLOSER = 320
_UNLIKE = Likeness(distance=0.006, angle_deg=12.0)


def candidates(
    workspace: Workspace,
    hand: Hand,
    samples: int,
    rng: np.random.Generator,
    rejected: Rejections,
    turn_deg: float = 0.0,
) -> Placements:
    """Search around sampled points and keep promising hands that are unlike each other.

    Parameters
    ----------
    samples : int
        Points in focus that are drawn; all of them, where there are no more.
    rejected : Rejections
        Every hand pose that is left out is counted here.
    turn_deg : float
        By which all hands are turned further, for another try.
    """
    wanted = np.nonzero(workspace.in_focus)[0]
    if len(wanted) > samples:
        wanted = np.sort(rng.choice(wanted, samples, replace=False))
    points = workspace.points[wanted]
    frames = local_frames(
        points, workspace.normals[wanted], workspace.coarse, workspace.coarse_normals
    )
    hands = hypothesise(frames, workspace.up, workspace.viewpoint, turn_deg)
    placed = search(workspace, hand, points, hands, rejected)
    opening = np.minimum(placed.right - placed.left + 2 * hand.clearance, hand.max_opening)
    tips, palm = support_clearance(placed, hand, opening, workspace)
    low = (tips < TOUCHES * hand.support_clearance) | (palm < hand.palm_clearance)
    rejected.counts["collision_support"] += int(low.sum())
    if rejected.wanted:
        keep_placed(rejected, "support_plane", hand, placed.take(rejected.some(low)))
    placed = placed.take(~low)
    order = np.argsort(-promise(workspace, hand, placed), kind="stable")
    centres, rotations = tool_centre(placed, hand)[order], placed.rotation[order]
    kept = distinct(centres, rotations, _LOOK_CLOSER, _UNLIKE)
    rejected.counts["less_promising"] += len(order) - len(kept)
    if rejected.wanted:
        keep_unlike(rejected, hand, placed, order, kept, _LOOK_CLOSER)
    return placed.take(np.sort(order[kept]))
