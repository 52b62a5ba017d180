"""Keep grasps that differ: non-maximum suppression over poses."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]

_NEAR = 0.010
_ALIKE_COS = float(np.cos(np.radians(20.0)))


def distinct(centres: Array, rotations: Array, limit: int) -> NDArray[np.intp]:
    """Return indices of grasps that are not close to a better one.

    Two grasps are close when their tool centre points are less than 10 mm and
    their axes less than 20 degrees apart; a half turn about the approach is the
    same grasp of a parallel gripper.

    Parameters
    ----------
    centres : (G, 3) array
    rotations : (G, 3, 3) array
        Best grasp first.
    limit : int
        Return at most so many.
    """
    return _distinct(
        np.ascontiguousarray(centres),
        np.ascontiguousarray(rotations[:, :, 2]),
        np.ascontiguousarray(rotations[:, :, 1]),
        limit,
    )


@kernel
def _distinct(centres: Array, approach: Array, closing: Array, limit: int) -> NDArray[np.intp]:
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
            if away < _NEAR**2 and along > _ALIKE_COS and abs(across) > _ALIKE_COS:
                alike = True
                break
        if not alike:
            kept[count] = index
            count += 1
    return kept[:count]
