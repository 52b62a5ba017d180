"""The best grasps that hold the region."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from services.matching.checks import check_finite
from shared.errors import EmptyCloud, InvalidInput
from shared.schemas.grasp import SelectRequest, SelectResponse

_SCORE = 8
_SAME_DISTANCE = 1e-9


def select_grasps(request: SelectRequest) -> SelectResponse:
    """Return the grasps whose closest object point lies in the region, best score first.

    Closest is meant to the tool centre point (thesis 5.4: grasp matching).
    Grasps of equal score keep the order of the request. `outside_region` counts
    all candidates that hold another part, also beyond `max_grasps`.

    Raises
    ------
    InvalidInput
        Non-finite points or grasps, or a region mask of another length.
    EmptyCloud
        Grasps, but no point that they could hold.
    """
    points, region, grasps = request.points, request.point_region, request.grasps
    if len(region) != len(points):
        raise InvalidInput(
            f"point_region has {len(region)} entries for {len(points)} points",
            field="point_region",
            found=len(region),
            allowed=len(points),
        )
    check_finite("points", points)
    check_finite("grasps", grasps)
    if len(grasps) and not len(points):
        raise EmptyCloud(f"there are {len(grasps)} grasps, but no object points", field="points")
    inside = holds_region(grasps[:, :3], points, region)
    order = np.argsort(-grasps[:, _SCORE], kind="stable")
    chosen = order[inside[order]][: request.max_grasps]
    return SelectResponse(
        grasps=grasps[chosen],
        indices=chosen.astype(np.int32),
        outside_region=int((~inside).sum()),
    )


def holds_region(
    centres: NDArray[np.float64], points: NDArray[np.float64], region: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Say for each tool centre point (G, 3) whether its closest point (N, 3) is in the region.

    Where several points are equally close (within a nanometre), one of them in
    the region is enough, so that the order of the points does not matter.
    """
    if not len(centres) or not region.any():
        return np.zeros(len(centres), dtype=np.bool_)
    to_any, _ = cKDTree(points).query(centres)
    to_region, _ = cKDTree(points[region]).query(centres)
    return np.asarray(to_region <= to_any + _SAME_DISTANCE)
