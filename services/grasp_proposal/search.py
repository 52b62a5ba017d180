"""Hand search: where, how wide and how deep each oriented hand can reach around the part.

A hand that moves straight along its approach sweeps everything in front of its
fingers. So for each hand the surface within the width of a finger is reduced to
its profile: the nearest depth over bins of the closing direction. A finger fits
wherever the profile stays deeper than its tip over its own thickness; the part is
what lies between the nearest two such places left and right of the sample.
"""

from __future__ import annotations

from collections import Counter

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.hand import Hand
from services.grasp_proposal.orientations import Hands
from services.grasp_proposal.placements import Placements, join
from services.grasp_proposal.ragged import padded_columns
from services.grasp_proposal.workspace import Workspace

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_BIN = 0.0025
_SLAB_MARGIN = 0.0015
_TIP_MARGIN = 0.001
_DEPTHS = np.array([0.005, 0.010, 0.016, 0.023, 0.031, 0.041])
_LEAST_DEPTH = 0.0005
_GOOD_ENGAGEMENT = 0.022
_CHUNK = 250_000


def search(
    workspace: Workspace, hand: Hand, points: Array, hands: Hands, rejected: Counter[str]
) -> Placements:
    """Return at most one placement per hand: the depth that holds the part best.

    Parameters
    ----------
    points : (S, 3) array
        Where the hands are tried.
    hands : Hands
        K orientations at each.
    rejected : Counter
        Every hand pose (orientation and depth) that is left out is counted here.
    """
    reach = hand.max_opening + hand.finger_thickness + 3 * hand.clearance
    radius = np.hypot(reach, hand.finger_length)
    surface = workspace.coarse.astype(np.float32)
    padded = np.vstack([surface, np.full(3, 1e6, dtype=np.float32)])
    chunk = max(1, _CHUNK // (len(surface) * hands.rotations.shape[1]))
    found = []
    for start in range(0, len(points), chunk):
        rows = slice(start, start + chunk)
        centres = points[rows, None].astype(np.float32)
        near = ((surface - centres) ** 2).sum(axis=2) < radius**2
        index, _ = padded_columns(near, filler=len(surface))
        around = padded[index] - centres
        profile, half = _profiles(around, hands.rotations[rows], hand, reach)
        possible = hands.possible[rows].ravel()
        rotation = hands.rotations[rows].reshape(-1, 3, 3)[possible]
        origin = np.repeat(points[rows], hands.rotations.shape[1], axis=0)[possible]
        rejected["collision_support"] += int((~possible).sum())
        found.append(_place(workspace, hand, rotation, origin, profile[possible], half, rejected))
    return join(found)


def _profiles(
    around: NDArray[np.float32], rotations: Array, hand: Hand, reach: float
) -> tuple[NDArray[np.float32], int]:
    """Return the profile (S*K, 2*half+1) of the points (S, n, 3) before each hand (S, K)."""
    count, kinds = rotations.shape[:2]
    half = int(np.ceil(reach / _BIN))
    bins = 2 * half + 1
    axes = rotations.astype(np.float32).transpose(3, 0, 2, 1)  # x, y, z: each (S, 3, K)
    in_slab = np.abs(around @ axes[0]) < hand.finger_width / 2 + _SLAB_MARGIN
    y = around @ (axes[1] / np.float32(_BIN))
    in_slab &= np.abs(y) < half + 0.49
    chosen = np.flatnonzero(in_slab)
    z = (around @ axes[2]).ravel()[chosen]
    of_hand = np.arange(count)[:, None, None] * kinds + np.arange(kinds)
    first = np.broadcast_to((of_hand * bins + half).astype(np.int32), in_slab.shape)
    cell = first[in_slab] + np.rint(y.ravel()[chosen]).astype(np.int32)
    profile = np.full(count * kinds * bins, np.inf, dtype=np.float32)
    np.minimum.at(profile, cell, z)
    return profile.reshape(count * kinds, bins), half


def _place(
    workspace: Workspace,
    hand: Hand,
    rotation: Array,
    origin: Array,
    profile: NDArray[np.float32],
    half: int,
    rejected: Counter[str],
) -> Placements:
    tip, tried = _depths(workspace, hand, rotation, origin)
    rejected["collision_support"] += int((~tried.any(axis=1)).sum())
    nearest = np.ascontiguousarray(profile.T)[:, :, None]  # bins first: scanned one by one
    occupied = nearest < (tip + _TIP_MARGIN).astype(np.float32)
    need = int(np.ceil((hand.finger_thickness + hand.clearance) / _BIN)) + 1
    right = _first_gap(occupied[half:], need)
    left = _first_gap(occupied[half::-1], need)
    enclosed = (right >= 0) & (left >= 0)
    width = (right + left + 1) * _BIN
    fits = enclosed & (width <= hand.max_width)
    steps = (np.arange(len(nearest), dtype=np.int32) - half)[:, None, None]
    between = (steps >= -left) & (steps <= right)
    front = np.where(between, nearest, np.float32(np.inf)).min(axis=0)
    clear = front > tip - hand.finger_length + hand.palm_clearance
    rejected["too_wide"] += int((tried & ~fits).sum())
    rejected["collision_object"] += int((tried & fits & ~clear).sum())
    good = tried & fits & clear
    value = np.minimum(tip - front, _GOOD_ENGAGEMENT) / _GOOD_ENGAGEMENT
    value = np.where(good, value * (1 - 0.5 * width / hand.max_opening), -np.inf)
    best = np.argmax(value, axis=1)
    rows = np.nonzero(good.any(axis=1))[0]
    rejected["other_depth_better"] += int(good.sum()) - len(rows)
    pick = (rows, best[rows])
    return Placements(
        rotation[rows],
        origin[rows],
        tip[pick],
        -(left[pick] + 0.5) * _BIN,
        (right[pick] + 0.5) * _BIN,
        front[pick].astype(np.float64),
    )


def _depths(workspace: Workspace, hand: Hand, rotation: Array, origin: Array) -> tuple[Array, Mask]:
    """Return tip depths (H, D) past the origin, and which of them to try."""
    tip = np.broadcast_to(_DEPTHS, (len(rotation), len(_DEPTHS)))
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


def _first_gap(occupied: Mask, need: int) -> NDArray[np.int32]:
    """Return the last occupied bin before the first run of `need` free ones, else -1.

    `occupied` is (n, H, D), counted outwards from the sample's own bin.
    """
    free = np.zeros(occupied.shape[1:], dtype=np.int32)
    last = np.full(occupied.shape[1:], -1, dtype=np.int32)
    for step, taken in enumerate(occupied):
        free += 1
        free[taken] = 0
        done = (free == need) & (last < 0)
        last[done] = max(step - need, 0)
    return last
