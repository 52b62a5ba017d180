"""The search's inner loop: hands pushed forward over what lies before them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]
Bins = NDArray[np.int32]
Fates = NDArray[np.int8]
Mask = NDArray[np.bool_]


UNTRIED, GOOD, TOO_WIDE, COLLIDES = 0, 1, 2, 3
"""What became of a hand at one depth."""


class Reach(NamedTuple):
    """What a hand sweeps, metres but for the bins.

    `half_bins` bins of `bin_size` on each side of the sample make a profile; a finger
    needs `free_bins` of them. `half_slab` is how far along x a point concerns the hand,
    `radius` how far from the sample.
    """

    radius: float
    half_slab: float
    bin_size: float
    half_bins: int
    free_bins: int
    tip_margin: float
    max_width: float
    max_opening: float
    depth_behind_tip: float
    good_engagement: float


class Found(NamedTuple):
    """For each of H hands two depths, (H, 2) each: the one that holds the part best, the deepest.

    `depth` is the index, -1 for none; the second is -1 as well where it would be the first.
    There the part covers `left` bins to the left of the sample's own and `right` to the
    right, and begins at `front` (metres along the approach). `fate` (H, D) says what became
    of every depth.
    """

    depth: Bins
    left: Bins
    right: Bins
    front: Array
    fate: Fates


@kernel
def place_hands(
    surface: Array,
    samples: Array,
    of_sample: NDArray[np.int64],
    rotations: Array,
    tips: Array,
    tried: Mask,
    reach: Reach,
) -> Found:
    """Find how deep each hand may reach around the part, and between which edges.

    Parameters
    ----------
    surface : (N, 3) array
    samples : (S, 3) array
        Where hands are tried.
    of_sample : (H,) array
        Sample of each hand; those of one sample follow each other.
    rotations : (H, 3, 3) array
        Columns x, y (closing), z (approach).
    tips : (H, D) array
        How far past the sample the finger tips may go.
    tried : (H, D) bool array
        Which of them to try.
    """
    hands, depths = tips.shape
    depth, left = np.full((hands, 2), -1, dtype=np.int32), np.zeros((hands, 2), dtype=np.int32)
    right, front = np.zeros((hands, 2), dtype=np.int32), np.zeros((hands, 2))
    around, along = np.empty((3, len(surface))), np.empty(len(surface))
    inside = np.empty(len(surface), dtype=np.int32)
    profile = np.empty(2 * reach.half_bins + 1)
    fate = np.full((hands, depths), UNTRIED, dtype=np.int8)
    near, within, cut_by = 0, 0, -1
    for h in range(hands):
        if not tried[h].any():
            continue
        turned = cut_by < 0 or (rotations[h, :, 0] != rotations[cut_by, :, 0]).any()
        moved = cut_by < 0 or of_sample[h] != of_sample[cut_by]
        if moved:
            near = _around(surface, samples[of_sample[h]], reach.radius, around)
        if moved or turned:
            within = _cut_slab(around[:, :near], rotations[h], reach.half_slab, along, inside)
            cut_by = h
        _draw_profile(around, inside[:within], rotations[h], reach, profile)
        most = -np.inf
        for d in range(depths):
            if not tried[h, d]:
                continue
            deepest = tips[h, d] + reach.tip_margin
            to_right = _first_gap(profile, reach.half_bins, 1, deepest, reach.free_bins)
            to_left = _first_gap(profile, reach.half_bins, -1, deepest, reach.free_bins)
            width = (to_left + to_right + 1) * reach.bin_size
            if to_right < 0 or to_left < 0 or width > reach.max_width:
                fate[h, d] = TOO_WIDE
                continue
            nearest = np.inf
            for k in range(reach.half_bins - to_left, reach.half_bins + to_right + 1):
                nearest = min(nearest, profile[k])
            if not nearest > tips[h, d] - reach.depth_behind_tip:
                fate[h, d] = COLLIDES
                continue
            fate[h, d] = GOOD
            engaged = min(tips[h, d] - nearest, reach.good_engagement) / reach.good_engagement
            value = engaged * (1.0 - 0.5 * width / reach.max_opening)
            for which in range(2):  # depths rise: the last good one is the deepest
                if which == 0 and not value > most:
                    continue
                depth[h, which], front[h, which] = d, nearest
                left[h, which], right[h, which] = to_left, to_right
            most = max(most, value)
        if depth[h, 1] == depth[h, 0]:
            depth[h, 1] = -1
    return Found(depth, left, right, front, fate)


@kernel
def _around(surface: Array, centre: Array, radius: float, around: Array) -> int:
    """Write the points (N, 3) within `radius` of `centre`, relative to it, into columns."""
    count = 0
    for n in range(len(surface)):
        x = surface[n, 0] - centre[0]
        y = surface[n, 1] - centre[1]
        z = surface[n, 2] - centre[2]
        if x * x + y * y + z * z < radius * radius:
            around[0, count] = x
            around[1, count] = y
            around[2, count] = z
            count += 1
    return count


@kernel
def _cut_slab(around: Array, rotation: Array, half_slab: float, along: Array, inside: Bins) -> int:
    """Write which of the points (3, N) lie in the hand's slab, and return how many do.

    `along` and `inside` are room for one number per point. Which points lie in the slab is
    as good as random, so it is found without a branch, which the processor would mispredict.
    """
    px, py, pz = around[0], around[1], around[2]
    a, b, c = rotation[0, 0], rotation[1, 0], rotation[2, 0]
    for n in range(len(px)):  # nothing but sums of products: vector instructions
        along[n] = abs(a * px[n] + b * py[n] + c * pz[n])
    count = np.uint64(0)
    for n in range(len(px)):
        inside[count] = n
        count += np.uint64(along[n] < half_slab)
    return int(count)


@kernel
def _draw_profile(
    around: Array, inside: Bins, rotation: Array, reach: Reach, profile: Array
) -> None:
    """Write the nearest depth in each bin of the closing direction, inf where there is none.

    Of the points (3, N) those count that `inside` names.
    """
    profile[:] = np.inf
    px, py, pz = around[0], around[1], around[2]
    bins = 1.0 / reach.bin_size
    a, b, c = bins * rotation[0, 1], bins * rotation[1, 1], bins * rotation[2, 1]
    zx, zy, zz = rotation[0, 2], rotation[1, 2], rotation[2, 2]
    middle, last = reach.half_bins + 0.5, float(len(profile))
    for i in range(len(inside)):
        row = np.uint64(inside[i])
        place = a * px[row] + b * py[row] + c * pz[row] + middle
        if 0.0 <= place < last:
            k = np.uint64(place)
            profile[k] = min(profile[k], zx * px[row] + zy * py[row] + zz * pz[row])


@kernel
def _first_gap(profile: Array, start: int, step: int, deepest: float, need: int) -> int:
    """Return how many bins from `start` the last occupied one is before `need` free ones, or -1.

    A bin is free where nothing is nearer than `deepest`.
    """
    free = 0
    for k in range(start + 1):
        free = 0 if profile[start + step * k] < deepest else free + 1
        if free == need:
            return max(k - need, 0)
    return -1
