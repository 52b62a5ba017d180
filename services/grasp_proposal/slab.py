"""The surface that a hand sees before its fingers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.boxes import local_coordinates
from services.grasp_proposal.placements import Placements
from services.grasp_proposal.ragged import padded_columns
from services.grasp_proposal.workspace import Workspace


@dataclass(frozen=True)
class Slab:
    """The surface about a finger's width before each of G hands; rows are padded with NaN.

    Attributes
    ----------
    local : (G, 3, n) array
        Coordinates from the placement's origin, along its axes.
    points, normals : (G, n, 3) float32 arrays
        The same points in the workspace.
    in_focus : (G, n) bool array
    """

    local: NDArray[np.float32]
    points: NDArray[np.float32]
    normals: NDArray[np.float32]
    in_focus: NDArray[np.bool_]


def cut_slab(workspace: Workspace, placed: Placements, half_width: float, below_tip: float) -> Slab:
    """Return what lies within `half_width` along x, down to `below_tip` past the tips."""
    local = local_coordinates(placed, workspace.points)
    inside = np.abs(local[:, 0]) < half_width
    inside &= local[:, 2] < (placed.tip + below_tip)[:, None]
    index, filled = padded_columns(inside)
    gathered = np.take_along_axis(local, index[:, None], axis=2)
    gathered[np.broadcast_to(~filled[:, None], gathered.shape)] = np.nan
    return Slab(
        gathered,
        workspace.points.astype(np.float32)[index],
        workspace.normals.astype(np.float32)[index],
        workspace.in_focus[index],
    )
