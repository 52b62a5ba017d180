"""Kernels on pictures against scipy's."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import ConvexHull

from services.primitive_recovery.parts.grid import (
    branch_sums,
    distance_to_unset,
    grown,
    solidity,
)


def blobs(seed: int) -> NDArray[np.bool_]:
    rng = np.random.default_rng(seed)
    mask = np.asarray(ndimage.gaussian_filter(rng.random((31, 44)), 2) > 0.5)
    mask[[0, -1]] = mask[:, [0, -1]] = False
    return mask


@pytest.mark.parametrize("seed", range(5))
def test_distances_are_exact(seed: int) -> None:
    mask = blobs(seed)
    np.testing.assert_allclose(distance_to_unset(mask), ndimage.distance_transform_edt(mask))
    np.testing.assert_allclose(distance_to_unset(~mask), ndimage.distance_transform_edt(~mask))


@pytest.mark.parametrize("seed", range(5))
def test_solidity_is_the_share_of_the_hull(seed: int) -> None:
    mask = blobs(seed)
    cells = np.argwhere(mask)
    corners = np.concatenate([cells + np.array(o) for o in ((0, 0), (0, 1), (1, 0), (1, 1))])
    assert solidity(mask) == pytest.approx(mask.sum() / ConvexHull(corners).volume)


def test_solidity_of_a_rectangle_is_one() -> None:
    mask = np.zeros((9, 12), dtype=bool)
    mask[2:5, 3:11] = True
    assert solidity(mask) == pytest.approx(1.0)


@pytest.mark.parametrize("times", [1, 2, 3])
def test_growing_is_dilation(times: int) -> None:
    mask = blobs(7)
    square = np.ones((3, 3), dtype=bool)
    expected = ndimage.binary_dilation(mask, square, iterations=times)
    np.testing.assert_array_equal(grown(mask, times), expected)


def test_sums_of_a_branch_beside_a_hole() -> None:
    rest, branch = np.zeros((8, 9), dtype=bool), np.zeros((8, 9), dtype=bool)
    rest[2:6, 2:4] = True
    branch[2, 4:7] = branch[5, 4:7] = branch[2:6, 6] = True
    holes = np.zeros((8, 9), dtype=np.int32)
    holes[3:5, 4:6] = 1
    near, tall = np.indices(rest.shape).astype(np.float64)
    sums, touched = branch_sums(branch, rest, holes, 1, near, tall)
    assert touched.tolist() == [False, True]
    assert sums[0, 0] == branch.sum()
    assert sums[1, 0] == rest.sum()
    assert sums[2, 0] == 2  # its two ends
    np.testing.assert_allclose(sums[0, 1:3] / sums[0, 0], np.argwhere(branch).mean(axis=0))
    assert sums[0, 6] == pytest.approx(near[branch].sum())
    assert (sums[0, 10], sums[0, 11]) == (4.0, 6.0)
