"""One pad against the part: which way the surface faces, and whether it ends there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.closer_look import STRIPS, PadMarks
from services.grasp_proposal.eigen import principal_frames
from services.grasp_proposal.workspace import Workspace
from shared.geometry.rotation import unit

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_SLOPE = 0.75


class Side(NamedTuple):
    """Contact with one pad, each (G,): as in `Contacts`, and the mean x of its points.

    `in_focus` is the share of the points touched where a grasp is wanted.
    """

    alignment: Array
    sloped: Mask
    coverage: Array
    x: Array
    in_focus: Array


def touch_side(workspace: Workspace, closing: Array, pad: PadMarks, sign: int) -> Side:
    """Return the contact on one side (-1 left, +1 right) of hands that close along `closing`.

    The contact normal is that of the visible surface at the edge. Where the
    surface ends there as the sensor saw it, the pad touches what lies behind the
    outline; then the normal is that of the apparent contour, perpendicular to
    both the line of sight and the outline (Cipolla and Giblin 1990).
    """
    alignment = sign * np.einsum("gi,gi->g", unit(pad.normal), closing)
    if workspace.viewpoint is not None:
        outline = principal_frames(pad.scatter)[1][:, :, 2]
        contour = unit(np.cross(outline, pad.centre - workspace.viewpoint))
        facing = np.abs(np.einsum("gi,gi->g", contour, closing))
        alignment = np.where(pad.goes_on, alignment, np.maximum(alignment, facing))
    corner = pad.widens & (pad.strips <= 1)
    sloped = (pad.goes_on & (alignment < _SLOPE)) | corner
    in_focus = pad.in_focus / np.maximum(pad.touched, 1)
    return Side(alignment, sloped, pad.strips / STRIPS, pad.x, in_focus)
