"""What is left out on the way: how many hand poses by reason and, where wanted, some of them."""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shared.geometry.spread import spread
from shared.schemas.rejection import ORDER, WHY_REJECTED, RejectionCode

Array = NDArray[np.float64]
Rows = NDArray[np.intp]
Mask = NDArray[np.bool_]

_STREAM = 1
"""Examples have random numbers of their own: grasps are the same with and without them."""
_POOL = 4
"""Of each reason and step so many times as many are kept as are wanted in all."""


class HandPoses(NamedTuple):
    """Hand poses in the workspace.

    Attributes
    ----------
    centres : (R, 3) array
        Tool centre points.
    rotations : (R, 3, 3) array
        Columns x, y (closing), z (approach).
    widths : (R,) array
        Opening that each would need, metres.
    """

    centres: Array
    rotations: Array
    widths: Array


class Rejections:
    """Counts hand poses that are left out, and keeps examples where some are wanted.

    Parameters
    ----------
    wanted : int
        Examples that `examples` gives at most; with 0 none are looked for.
    seed : int

    Attributes
    ----------
    counts : Counter
        Hand poses by reason, as in `ProposeResponse.rejected`.
    wanted : int
    """

    def __init__(self, wanted: int = 0, seed: int = 0) -> None:
        self.counts: Counter[str] = Counter()
        self.wanted = wanted
        self._rng = np.random.default_rng([seed, _STREAM])
        self._kept: dict[RejectionCode, list[HandPoses]] = {}

    def some(self, which: Mask | Rows) -> Rows:
        """Return indices of some of the rows that are marked, at random and in rising order."""
        rows: Rows = np.flatnonzero(which) if which.dtype == np.bool_ else which.astype(np.intp)
        most = _POOL * self.wanted
        return rows if len(rows) <= most else np.sort(self._rng.choice(rows, most, replace=False))

    def keep(self, code: RejectionCode, poses: HandPoses) -> None:
        """Take poses as examples of what `code` says."""
        if len(poses.widths):
            self._kept.setdefault(code, []).append(poses)

    def examples(self) -> tuple[HandPoses, tuple[RejectionCode, ...]]:
        """Return at most `wanted` poses, spread over reasons and space, and why each is left out.

        By reason in the order of `WHY_REJECTED`, each pose far from those before it.
        """
        codes = [code for code in WHY_REJECTED if code in self._kept]
        kept = [poses for code in codes for poses in self._kept[code]]
        if not kept:
            return HandPoses(np.empty((0, 3)), np.empty((0, 3, 3)), np.empty(0)), ()
        every = HandPoses(*(np.concatenate(each) for each in zip(*kept, strict=True)))
        numbers = [sum(len(poses.widths) for poses in self._kept[code]) for code in codes]
        groups = np.repeat([ORDER[code] for code in codes], numbers)
        approaches = every.rotations[:, :, 2]
        rows = spread(groups, every.centres, approaches, self.wanted, self._rng)
        names = list(WHY_REJECTED)
        chosen = HandPoses(*(each[rows] for each in every))
        return chosen, tuple(names[group] for group in groups[rows])
