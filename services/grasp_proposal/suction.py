"""Grasps of a suction cup: where its lip seals, reached along the inward normal.

After Mahler et al., Dex-Net 3.0 (ICRA 2018): a cup holds where its lip follows the
surface all around, and as long as the weight and its torque about the lip stay below
what the vacuum presses the lip on with. The lip here is a ring of sectors that must all
lie on the seen surface, within the cup's compliance; that bounds the curvature as well,
since a surface of radius R falls by r**2 / 2R over a lip of radius r.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.cup import Cup
from services.grasp_proposal.diversity import distinct
from services.grasp_proposal.rejections import Rejections
from services.grasp_proposal.seal import SECTORS, Seal, seal
from services.grasp_proposal.suction_examples import SuctionExamples
from services.grasp_proposal.workspace import Workspace
from shared.geometry.rotation import unit

Array = NDArray[np.float64]

_DEEPEST = 3.0
_STEEPEST_RISE = 0.3
_FRICTION = 0.5
_LEAST_MARGIN = 1.0


class Cups(NamedTuple):
    """Suction grasps in the workspace, best first: (G, 3), (G, 3, 3), (G,) and (G,) arrays."""

    centres: Array
    rotations: Array
    scores: Array
    in_focus: Array


def propose_suction(
    workspace: Workspace,
    cup: Cup,
    samples: int,
    rng: np.random.Generator,
    rejected: Rejections,
    limit: int,
) -> Cups:
    """Return at most `limit` places where the cup seals, touches nothing else and holds.

    Parameters
    ----------
    samples : int
        Points in focus that are tried.
    rejected : Rejections
        Gets one count per place left out: `no_seal`, `collision_object`,
        `collision_support`, `collision_obstacle`, `too_heavy`, `duplicate`.
    """
    wanted = np.flatnonzero(workspace.in_focus)
    if len(wanted) > samples:
        wanted = np.sort(rng.choice(wanted, samples, replace=False))
    centres = workspace.points[wanted]
    rotations = _facing(-workspace.normals[wanted], workspace.up)
    measured = seal(
        workspace.points,
        workspace.in_focus,
        centres,
        rotations,
        cup.radius,
        _DEEPEST * cup.compliance,
    )
    margin = _margin(workspace, cup, centres, rotations)
    low = cup.clearance(centres, rotations, workspace) < cup.support_clearance
    rising = np.zeros(len(centres), dtype=np.bool_)
    if workspace.up is not None:
        rising = rotations[:, :, 2] @ workspace.up > _STEEPEST_RISE
    above = 2 * cup.compliance
    examples = SuctionExamples(rejected, workspace, cup, centres, rotations, above)
    failures = {
        "no_seal": (measured.covered < SECTORS)
        | (measured.gap > cup.compliance)
        | (measured.bump > cup.compliance),
        "collision_support": low | rising,
        "collision_object": cup.hits(centres, rotations, workspace.points, above),
        "collision_obstacle": cup.hits(centres, rotations, workspace.obstacles, 0.0),
        "too_heavy": margin < _LEAST_MARGIN,
    }
    good = np.ones(len(centres), dtype=np.bool_)
    for reason, failed in failures.items():
        rejected.counts[reason] += int((good & failed).sum())
        examples.failed(reason, good & failed, rising)
        good &= ~failed
    rows = np.flatnonzero(good)
    scores = _score(cup, measured, margin)[rows]
    order = rows[np.argsort(-scores, kind="stable")]
    round_cups = np.repeat(rotations[order][:, :, 2:], 3, axis=2)  # a turn about z changes nothing
    unlike = distinct(centres[order], round_cups, limit)
    rejected.counts["duplicate"] += len(order) - len(unlike)
    examples.alike(order, unlike, limit)
    kept = order[unlike]
    return Cups(
        centres[kept],
        rotations[kept],
        _score(cup, measured, margin)[kept],
        measured.in_focus[kept],
    )


def _facing(approach: Array, up: Array | None) -> Array:
    """Return rotations (S, 3, 3) with z along `approach`; y is level, as +y is free to choose."""
    aside = np.zeros_like(approach)
    if up is not None:
        aside = np.cross(approach, up)
    fallback = np.eye(3)[np.argmin(np.abs(approach), axis=1)]
    fallback = fallback - approach * np.einsum("si,si->s", fallback, approach)[:, None]
    short = np.linalg.norm(aside, axis=1, keepdims=True) < 0.1
    y_axis = unit(np.where(short, fallback, aside))
    return np.stack([np.cross(y_axis, approach), y_axis, approach], axis=2)


def _margin(workspace: Workspace, cup: Cup, centres: Array, rotations: Array) -> Array:
    """Return how many times the guessed weight the cup holds at each place (S,).

    The least of: straight off against the vacuum's force; along the lip against its
    friction; the weight's torque against the vacuum's force at the lip's radius.
    """
    if workspace.up is None:
        return np.full(len(centres), np.inf)
    weight = workspace.weight
    along = rotations[:, :, 2] @ -workspace.up  # pulls off, where the cup comes from above
    off = weight * np.maximum(np.abs(along), 1e-9)
    slide = weight * np.maximum(np.sqrt(np.maximum(1 - along**2, 0.0)), 1e-9)
    lever = np.cross(workspace.centre_of_mass - centres, -workspace.up * weight)
    about = lever - np.einsum("si,si->s", lever, rotations[:, :, 2])[:, None] * rotations[:, :, 2]
    torque = np.maximum(np.linalg.norm(about, axis=1), 1e-9)
    straight, along_lip = cup.force / off, _FRICTION * cup.force / slide
    return np.asarray(np.minimum(np.minimum(straight, along_lip), cup.force * cup.radius / torque))


def _score(cup: Cup, measured: Seal, margin: Array) -> Array:
    """Return the product of how well the lip follows, what is left to hold, and the focus."""
    follows = 1 - 0.7 * np.clip(np.maximum(measured.gap, measured.bump) / cup.compliance, 0, 1)
    holds = 1 - 1 / (1 + np.minimum(margin, 1e6) ** 2)
    return np.asarray(follows * holds * (0.2 + 0.8 * measured.in_focus))
