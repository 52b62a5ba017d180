"""Metres, told from millimetres."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.errors import WrongUnits
from shared.geometry.passes import corners
from shared.schemas.scene import InputKind

Array = NDArray[np.float64]

MAX_EXTENT_M = {"scene": 50.0, "object": 5.0}
"""Wider than this cannot be metres: a table seen in millimetres spans hundreds."""
_SAMPLE = 5000


def require_metres(points: Array, kind: InputKind, field: str) -> None:
    """Raise WrongUnits when points (N, 3) span too much.

    Only the extent is asked, so that a frame far away does no harm, and the outermost
    twentieths on each side are left out.
    """
    if len(points) == 0:
        return
    columns = np.ascontiguousarray(points[:: max(1, len(points) // _SAMPLE)].T)
    allowed = MAX_EXTENT_M[kind]
    with np.errstate(over="ignore", invalid="ignore"):  # depth times scale may be infinite
        if np.ptp(columns, axis=1).max() <= allowed:
            return
        low, high = np.percentile(columns, [5, 95], axis=1)
        extent = float(np.nan_to_num(high - low, nan=np.inf, posinf=np.inf).max())
    if extent > allowed:
        remedy = "divide them by 1000"
        if field == "depth":
            remedy = "give depth_scale in metres per unit (0.001 for millimetres)"
        raise WrongUnits(
            f"{field} span {extent:.4g} m, which looks like millimetres: "
            f"coordinates must be in metres; {remedy}",
            field=field,
            found=f"extent {extent:.4g}" if np.isfinite(extent) else "extent without bound",
            allowed=f"extent up to {allowed:g} m for input = {kind}",
        )


def checked_target(target: tuple[float, float, float], points: Array) -> Array:
    """Return `target` as an array (3,), if it may belong to points (N, 3).

    Raises
    ------
    WrongUnits
        It is so far from all points that it must be in millimetres.
    """
    low, high = corners(points)
    point = np.array(target)
    away = float(np.maximum(low - point, point - high).max())
    if away > MAX_EXTENT_M["scene"]:
        raise WrongUnits(
            f"target {list(target)} is {away:.4g} m away from all points, which looks like "
            "millimetres: it must be in metres, in the frame of the view",
            field="target",
            found=list(target),
            allowed="metres, near the points",
        )
    return point
