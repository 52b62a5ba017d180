"""Which hand poses an answer leaves out, and why: those of the proposer and those of here."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from services.matching.checks import check_finite
from shared.errors import InvalidInput
from shared.geometry.rotation import matrix_from_quaternion
from shared.geometry.spread import spread
from shared.schemas.grasp import SelectRequest
from shared.schemas.rejection import ORDER, WHY_REJECTED, RejectionCode

_STREAM = 2
_POSE_AND_WIDTH = 8
_OUTSIDE: tuple[RejectionCode, ...] = ("outside_region",)
_BEYOND: tuple[RejectionCode, ...] = ("beyond_max_grasps",)


def left_out(
    request: SelectRequest, inside: NDArray[np.bool_], chosen: NDArray[np.intp]
) -> dict[str, Any]:
    """Return the fields of a `SelectResponse` about rejected hand poses, where some are wanted.

    Evenly over the reasons, those of the proposer and the two from here (`outside_region`,
    `beyond_max_grasps`), and within each over space; see `spread`.

    Parameters
    ----------
    request : SelectRequest
    inside : (G,) array
        Which grasps hold the region.
    chosen : (K,) array
        Rows of those that are answered.

    Raises
    ------
    InvalidInput
        Poses that are not finite, or not as many reasons.
    """
    if not request.rejected:
        return {}
    poses = request.rejected_poses
    poses = np.empty((0, _POSE_AND_WIDTH)) if poses is None else poses
    if len(poses) != len(request.rejected_reasons):
        raise InvalidInput(
            f"there are {len(request.rejected_reasons)} rejected_reasons for "
            f"{len(poses)} rejected_poses",
            field="rejected_reasons",
            found=len(request.rejected_reasons),
            allowed=len(poses),
        )
    check_finite("rejected_poses", poses)
    beyond = inside.copy()
    beyond[chosen] = False
    outside, over = int((~inside).sum()), int(beyond.sum())
    codes = (*request.rejected_reasons, *_OUTSIDE * outside, *_BEYOND * over)
    own = request.grasps[:, :_POSE_AND_WIDTH]
    every = np.vstack([poses, own[~inside], own[beyond]])
    approaches = matrix_from_quaternion(every[:, 3:7])[..., 2].reshape(-1, 3)
    groups = np.array([ORDER[code] for code in codes], dtype=np.int64)
    rng = np.random.default_rng([request.seed, _STREAM])
    rows = spread(groups, every[:, :3], approaches, request.rejected, rng)
    names = list(WHY_REJECTED)
    return {
        "rejected_poses": every[rows],
        "rejected_reasons": tuple(names[group] for group in groups[rows]),
    }
