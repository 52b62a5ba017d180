"""Hand search: where, how wide and how deep each oriented hand can reach around the part.

A hand that moves straight along its approach sweeps everything in front of its
fingers. So for each hand the surface within the width of a finger is reduced to
its profile: the nearest depth over bins of the closing direction. A finger fits
wherever the profile stays deeper than its tip over its own thickness; the part is
what lies between the nearest two such places left and right of the sample.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.hand import Hand
from services.grasp_proposal.orientations import Hands
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.placing import COLLIDES, GOOD, TOO_WIDE, Found, Reach, place_hands
from services.grasp_proposal.rejections import Rejections
from services.grasp_proposal.search_examples import SearchExamples
from services.grasp_proposal.workspace import Workspace

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_BIN = 0.0025
_SLAB_MARGIN = 0.0015
_TIP_MARGIN = 0.001
_DEPTHS = np.array([0.005, 0.010, 0.016, 0.023, 0.031, 0.041])
_LEAST_DEPTH = 0.0005
_GOOD_ENGAGEMENT = 0.022

_second = ThreadPoolExecutor(max_workers=4, thread_name_prefix="hand-search")
"""Kernels run without the interpreter's lock, so the second half of a search costs no time where
a core is free. More threads than one, for several requests at once."""


def search(
    workspace: Workspace, hand: Hand, points: Array, hands: Hands, rejected: Rejections
) -> Placements:
    """Return at most two placements per hand: the depth that holds the part best, and the deepest.

    Parameters
    ----------
    points : (S, 3) array
        Where the hands are tried.
    hands : Hands
        K orientations at each.
    rejected : Rejections
        Every hand pose (orientation and depth) that is left out is counted here.
    """
    sample = np.ascontiguousarray(np.nonzero(hands.possible)[0])
    rotation, origin = hands.rotations[hands.possible], points[sample]
    tip, tried = _depths(workspace, hand, rotation, origin)
    counts, reach = rejected.counts, _reach(hand)
    counts["collision_support"] += int((~hands.possible).sum())
    counts["collision_support"] += int((~tried.any(axis=1)).sum())
    surface = np.vstack([workspace.coarse, workspace.floor])
    found = _placed(surface, points, sample, rotation, tip, tried, reach)
    rows, which = np.nonzero(found.depth >= 0)
    counts["too_wide"] += int((found.fate == TOO_WIDE).sum())
    counts["collision_object"] += int((found.fate == COLLIDES).sum())
    counts["other_depth_better"] += int((found.fate == GOOD).sum()) - len(rows)
    if rejected.wanted:
        examples = SearchExamples(rejected, surface, hand, points, reach)
        examples.impossible(hands)
        examples.tried(rotation, sample, tip, tried, found)
    return Placements(
        rotation[rows],
        origin[rows],
        tip[rows, found.depth[rows, which]],
        -_BIN * (found.left[rows, which].astype(np.float64) + 0.5),
        _BIN * (found.right[rows, which].astype(np.float64) + 0.5),
        found.front[rows, which],
    )


def _placed(
    surface: Array,
    points: Array,
    sample: NDArray[np.intp],
    rotation: Array,
    tip: Array,
    tried: Mask,
    reach: Reach,
) -> Found:
    """Return what `place_hands` does, half of the samples in a second thread."""
    middle = int(np.searchsorted(sample, sample[len(sample) // 2])) if len(sample) else 0
    parts = slice(0, middle), slice(middle, None)

    def place(part: slice) -> Found:
        return place_hands(
            surface, points, sample[part], rotation[part], tip[part], tried[part], reach
        )

    waited_for = _second.submit(place, parts[0])
    second = place(parts[1])
    first = waited_for.result()
    return Found(
        depth=np.concatenate([first.depth, second.depth]),
        left=np.concatenate([first.left, second.left]),
        right=np.concatenate([first.right, second.right]),
        front=np.concatenate([first.front, second.front]),
        fate=np.concatenate([first.fate, second.fate]),
    )


def _reach(hand: Hand) -> Reach:
    sideways = hand.max_opening + hand.finger_thickness + 3 * hand.clearance
    return Reach(
        radius=float(np.hypot(sideways, hand.finger_length)),
        half_slab=hand.finger_width / 2 + _SLAB_MARGIN,
        bin_size=_BIN,
        half_bins=int(np.ceil(sideways / _BIN)),
        free_bins=int(np.ceil((hand.finger_thickness + hand.clearance) / _BIN)) + 1,
        tip_margin=_TIP_MARGIN,
        max_width=hand.max_width,
        max_opening=hand.max_opening,
        depth_behind_tip=hand.finger_length - hand.palm_clearance,
        good_engagement=_GOOD_ENGAGEMENT,
    )


def _depths(workspace: Workspace, hand: Hand, rotation: Array, origin: Array) -> tuple[Array, Mask]:
    """Return tip depths (H, D) past the origin, and which of them to try."""
    tip = np.tile(_DEPTHS, (len(rotation), 1))
    if workspace.up is None or workspace.support_offset is None:
        return tip, np.ones(tip.shape, dtype=np.bool_)
    rise = np.einsum("hij,i->hj", rotation, workspace.up)
    corner = np.abs(rise[:, 0]) * hand.finger_width / 2 + np.abs(rise[:, 1]) * hand.finger_thickness
    room = workspace.heights(origin) - corner - hand.support_clearance
    deepest = np.where(
        rise[:, 2] < -0.02,
        room / np.maximum(-rise[:, 2], 0.02),
        np.where(room > 0, np.inf, -np.inf),
    )
    limited = np.minimum(tip, deepest[:, None])
    repeated = np.zeros(tip.shape, dtype=np.bool_)
    repeated[:, 1:] = limited[:, 1:] <= limited[:, :-1]
    tried = (limited >= _LEAST_DEPTH) & ~repeated
    return np.maximum(limited, 0.0), tried
