"""The best grasps that hold the region."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from services.matching.checks import check_finite
from services.matching.left_out import left_out
from shared.errors import EmptyCloud, InvalidInput
from shared.schemas.grasp import SelectRequest, SelectResponse

_SCORE = 8
_SAME_DISTANCE = 1e-9
_LEAST_SHARE = 0.5
_NEAR_THE_REST = 0.5


def select_grasps(request: SelectRequest) -> SelectResponse:
    """Return the grasps that hold the region, best first.

    The object point closest to the tool centre point must lie in the region (thesis 5.4:
    grasp matching), and, where the request says what each grasp holds, at least half of
    the points between the pads and half of those that each pad touches. Best is the
    highest score times the share of the points between the pads that lie in the region:
    the chance to lift the object by the right part, near whose border the share falls.
    The odds of a grasp whose way in comes near the rest of the object count half: where
    another is about as good, the parts that the task needs stay free. Equals keep the order
    of the request. `outside_region` counts all candidates that hold another part, also
    beyond `max_grasps`. Where rejected hand poses are asked for, see `left_out`.

    Raises
    ------
    InvalidInput
        Non-finite points or grasps, or a region mask, shares, ways or reasons of another length.
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
    shares = _checked_shares(request)
    inside = holds_region(grasps[:, :3], points, region) & (shares >= _LEAST_SHARE).all(axis=1)
    odds, against = grasps[:, _SCORE] * _checked_way(request), 1 - grasps[:, _SCORE]
    worth = odds / (odds + against) * shares[:, 0]
    order = np.argsort(-worth, kind="stable")
    chosen = order[inside[order]][: request.max_grasps]
    return SelectResponse(
        grasps=grasps[chosen],
        indices=chosen.astype(np.int32),
        outside_region=int((~inside).sum()),
        **left_out(request, inside, chosen),
    )


def _checked_shares(request: SelectRequest) -> NDArray[np.float64]:
    """Return the shares (G, 3); all ones where the request has none."""
    shares, grasps = request.on_region, request.grasps
    if shares is None:
        return np.ones((len(grasps), 3))
    _check_length("on_region", len(shares), len(grasps))
    check_finite("on_region", shares)
    return shares


def _checked_way(request: SelectRequest) -> NDArray[np.float64]:
    """Return what the way in of each grasp (G,) makes of its odds."""
    clear = request.keeps_clear
    if clear is None:
        return np.ones(len(request.grasps))
    _check_length("keeps_clear", len(clear), len(request.grasps))
    return np.where(clear, 1.0, _NEAR_THE_REST)


def _check_length(name: str, found: int, grasps: int) -> None:
    if found != grasps:
        raise InvalidInput(
            f"{name} has {found} rows for {grasps} grasps",
            field=name,
            found=found,
            allowed=grasps,
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
    to_region, to_rest = (_distances(centres, points[part]) for part in (region, ~region))
    return np.asarray(to_region <= to_rest + _SAME_DISTANCE)


def _distances(centres: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how far the closest point (N, 3) to each centre (G, 3) is, inf without points.

    There are few centres, so most of the time is that of building the tree: a coarse one, split
    in the middle, is built in a third of the time.
    """
    if not len(points):
        return np.full(len(centres), np.inf)
    tree = cKDTree(points, leafsize=64, compact_nodes=False, balanced_tree=False)
    return np.asarray(tree.query(centres)[0])
