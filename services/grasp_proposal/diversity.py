"""Keep grasps that differ: non-maximum suppression over poses."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_NEAR = 0.010
_ALIKE_COS = np.cos(np.radians(20.0))


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
    kept: list[int] = []
    for index in range(len(centres)):
        if len(kept) >= limit:
            break
        near = np.linalg.norm(centres[kept] - centres[index], axis=1) < _NEAR
        approach = rotations[kept][:, :, 2] @ rotations[index][:, 2] > _ALIKE_COS
        closing = np.abs(rotations[kept][:, :, 1] @ rotations[index][:, 1]) > _ALIKE_COS
        if not (near & approach & closing).any():
            kept.append(index)
    return np.array(kept, dtype=np.intp)
