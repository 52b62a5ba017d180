"""One pad against the part: which way the surface faces, and whether it ends there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.hand import Hand
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.slab import Slab
from services.grasp_proposal.workspace import Workspace
from shared.geometry.rotation import unit

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

CONTINUES = 0.006
_EDGE = 0.003
_CORNER = 0.004
_STRIPS = 4
_SLOPE = 0.75


class Side(NamedTuple):
    """Contact with one pad, each (G,): as in `Contacts`, and the mean x of its points."""

    alignment: Array
    sloped: Mask
    coverage: Array
    x: Array


def touch_side(
    workspace: Workspace,
    placed: Placements,
    hand: Hand,
    slab: Slab,
    held: Mask,
    sign: int,
    edge: Array,
) -> Side:
    """Return the contact on one side (-1 left, +1 right).

    The contact normal is that of the visible surface at the edge. Where the
    surface ends there as the sensor saw it, the pad touches what lies behind the
    outline; then the normal is that of the apparent contour, perpendicular to
    both the line of sight and the outline (Cipolla and Giblin 1990).
    """
    x, z = slab.local[:, 0], slab.local[:, 2]
    outwards = sign * (slab.local[:, 1] - edge[:, None].astype(np.float32))
    contact = held & (outwards > -_EDGE)
    weight = (contact / np.maximum(contact.sum(axis=1), 1)[:, None]).astype(np.float32)
    closing = placed.rotation[:, :, 1]
    normal = unit(np.einsum("gn,gni->gi", weight, slab.normals))
    alignment = sign * np.einsum("gi,gi->g", normal, closing)
    in_width = np.abs(x) < hand.finger_width / 2
    beyond = in_width & (outwards > 0) & (outwards < CONTINUES)
    beyond &= z < (placed.tip + CONTINUES)[:, None]
    goes_on = beyond.any(axis=1)
    if workspace.viewpoint is not None:
        centre = np.einsum("gn,gni->gi", weight, slab.points)
        contour = unit(
            np.cross(_outline(slab.points, weight, centre), centre - workspace.viewpoint)
        )
        facing = np.abs(np.einsum("gi,gi->g", contour, closing))
        alignment = np.where(goes_on, alignment, np.maximum(alignment, facing))
    strip = np.floor((x / hand.finger_width + 0.5) * _STRIPS)
    filled = [(contact & (strip == s)).any(axis=1) for s in range(_STRIPS)]
    mean_x = (np.where(contact, x, 0.0) * weight).sum(axis=1)
    coverage = np.mean(filled, axis=0)
    widens = (np.abs(x) > hand.finger_width / 2) & (outwards > _CORNER) & (z < placed.tip[:, None])
    corner = (widens & (outwards < 3 * _CORNER)).any(axis=1) & (coverage * _STRIPS <= 1)
    sloped = (goes_on & (alignment < _SLOPE)) | corner
    return Side(alignment, sloped, coverage, mean_x)


def _outline(
    points: NDArray[np.float32], weight: NDArray[np.float32], centre: NDArray[np.float32]
) -> Array:
    """Return the main direction (G, 3) of the weighted points (G, n, 3)."""
    centred = (points - centre[:, None]) * np.sqrt(weight)[:, :, None]
    _, vectors = np.linalg.eigh(np.matmul(centred.transpose(0, 2, 1), centred))
    return np.asarray(vectors[:, :, 2])
