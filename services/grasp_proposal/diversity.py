"""Keep grasps that differ: non-maximum suppression over poses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Likeness:
    """When two grasps are alike: tool centre points and both axes less far apart than this.

    A half turn about the approach is the same grasp of a parallel gripper.
    """

    distance: float
    angle_deg: float


ANSWERED = Likeness(distance=0.010, angle_deg=20.0)


def distinct(
    centres: Array, rotations: Array, limit: int, likeness: Likeness = ANSWERED
) -> NDArray[np.intp]:
    """Return indices of grasps that are not like a better one.

    Parameters
    ----------
    centres : (G, 3) array
    rotations : (G, 3, 3) array
        Best grasp first.
    limit : int
        Return at most so many.
    likeness : Likeness
    """
    return _distinct(
        np.ascontiguousarray(centres),
        np.ascontiguousarray(rotations[:, :, 2]),
        np.ascontiguousarray(rotations[:, :, 1]),
        limit,
        likeness.distance,
        float(np.cos(np.radians(likeness.angle_deg))),
    )


@kernel
def _distinct(
    centres: Array, approach: Array, closing: Array, limit: int, near: float, cos: float
) -> NDArray[np.intp]:
    kept = np.empty(len(centres), dtype=np.intp)
    count = 0
    for index in range(len(centres)):
        if count >= limit:
            break
        alike = False
        for other in kept[:count]:
            away = along = across = 0.0
            for axis in range(3):
                away += (centres[other, axis] - centres[index, axis]) ** 2
                along += approach[other, axis] * approach[index, axis]
                across += closing[other, axis] * closing[index, axis]
            if away < near**2 and along > cos and abs(across) > cos:
                alike = True
                break
        if not alike:
            kept[count] = index
            count += 1
    return kept[:count]
