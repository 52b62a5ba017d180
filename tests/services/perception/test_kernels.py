"""The compiled loops, each against what NumPy, SciPy or Open3D make of the same arrays."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import open3d as o3d
import pytest
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial.transform import Rotation

from services.perception.cloud import cluster, thin
from services.perception.interpolation import interpolate
from services.perception.median import median
from services.perception.moments import biweight_moments, moments_near
from services.perception.own_frame import own_frame
from services.perception.pixels import (
    distances,
    heights_above,
    points_of_depth,
    points_within,
)
from services.perception.ransac import corners_and_normals, count_votes
from services.perception.relief_map import (
    grow,
    highest_around,
    points_over,
    survey,
    window_means,
)
from services.perception.voxels import voxel_means
from shared.geometry.passes import about_mean, corners
from shared.geometry.points import points_from_depth
from shared.geometry.rotation import unit
from shared.jit import read_only
from shared.settings import PROJECT_ROOT

Array = NDArray[np.float64]

EIGHT = np.ones((3, 3), dtype=bool)


def test_points_of_depth(rng: np.random.Generator) -> None:
    depth = rng.integers(0, 8000, (24, 31)).astype(np.float64)
    depth[rng.random(depth.shape) < 0.2] = 0
    depth[0, :4] = [np.nan, np.inf, -5.0, 65535.0]
    intrinsics = np.array([[500.0, 3.0, 15.2], [0, 510.0, 11.7], [0, 0, 1]])
    points, rows, reach = points_of_depth(read_only(depth), read_only(intrinsics), 1e-4, 65535.0)
    depth[0, :4] = 0
    expected = points_from_depth(depth, intrinsics, 1e-4)
    seen = np.flatnonzero(np.isfinite(expected[:, 2]))
    np.testing.assert_array_equal(rows, seen)
    np.testing.assert_allclose(points, expected[seen], rtol=1e-12)
    assert reach == np.abs(points).max()


def test_points_within(rng: np.random.Generator) -> None:
    points = rng.normal(0, 2, (50, 3))
    points[3, 1], points[7, 2], points[9, 0] = np.nan, np.inf, -np.inf
    for limit in (1.5, np.inf):
        kept, rows, reach = points_within(read_only(points), limit)
        expected = np.flatnonzero((np.abs(points) < limit).all(axis=1))
        np.testing.assert_array_equal(rows, expected)
        np.testing.assert_array_equal(kept, points[expected])
        assert reach == np.abs(kept).max()


def test_distances_and_heights(rng: np.random.Generator) -> None:
    points, origin = rng.normal(0, 1, (40, 3)), rng.normal(0, 1, 3)
    normal = unit(rng.normal(0, 1, 3))
    np.testing.assert_allclose(
        distances(points, origin), np.linalg.norm(points - origin, axis=1), rtol=1e-12
    )
    np.testing.assert_allclose(
        heights_above(points, normal, 0.3), points @ normal + 0.3, rtol=0, atol=1e-14
    )


@pytest.mark.parametrize("knots", [[1.0], [0.4, 1.0], [0.4, 0.7, 0.7, 1.1, 2.0]])
def test_interpolation(knots: list[float], rng: np.random.Generator) -> None:
    values = rng.uniform(1, 2, len(knots))
    at = np.concatenate([rng.uniform(0, 3, 200), np.sort(rng.uniform(0, 3, 50)), knots])
    np.testing.assert_allclose(
        interpolate(at, np.array(knots), values), np.interp(at, knots, values), rtol=1e-12
    )


@pytest.mark.parametrize("count", [1, 2, 7, 500, 501])
def test_median(count: int, rng: np.random.Generator) -> None:
    values = rng.normal(size=count)
    assert median(values) == np.median(values)


@pytest.mark.parametrize("count", [1, 3, 200, 5000])
def test_about_mean(count: int, rng: np.random.Generator) -> None:
    """To the last bit: NumPy adds the rows of such an array up one by one, too."""
    points = rng.normal(size=(count, 3)) + np.array([0.3, -2.0, 40.0])
    mean, centred = about_mean(points)
    np.testing.assert_array_equal(mean, points.mean(axis=0))
    np.testing.assert_array_equal(centred, points - points.mean(axis=0))


def test_moments(rng: np.random.Generator) -> None:
    points = rng.normal(0, 0.1, (300, 3)) + 1.0
    origin, normal, offset = points[0], unit([1.0, 2.0, -1.0]), 0.02
    centred = points - origin
    heights = np.abs(centred @ normal + offset)
    near = centred[heights < 0.05]
    planes = np.array([normal, [1.0, 0.0, 0.0]]), np.array([offset, 9.0])
    count, mean, scatter = moments_near(points, origin, *planes, 0.05)
    assert count.tolist() == [len(near), 0]
    np.testing.assert_allclose(mean[0], near.mean(axis=0), atol=1e-14)
    np.testing.assert_allclose(scatter[0], np.cov(near.T, bias=True), atol=1e-14)
    assert not mean[1].any()
    assert not scatter[1].any()
    weights = np.clip(1 - (heights / 0.08) ** 2, 0, None) ** 2
    for step in (1, 4):
        some, weight = centred[::step], weights[::step]
        total, middle, spread = biweight_moments(points, step, origin, normal, offset, 0.08)
        assert total == pytest.approx(weight.sum())
        np.testing.assert_allclose(middle, np.average(some, axis=0, weights=weight), atol=1e-14)
        np.testing.assert_allclose(spread, np.cov(some.T, aweights=weight, bias=True), atol=1e-14)


def test_votes(rng: np.random.Generator) -> None:
    points, normals = rng.normal(0, 0.02, (200, 3)), unit(rng.normal(0, 1, (7, 3)))
    offsets = rng.normal(0, 0.01, 7)
    away = (points @ normals.T + offsets) / 0.008
    np.testing.assert_allclose(
        count_votes(points, normals, offsets, 0.008),
        np.clip(1 - away**2, 0, None).sum(axis=0),
        rtol=1e-10,
    )


def test_corners_and_normals(rng: np.random.Generator) -> None:
    points, triples = rng.normal(size=(30, 3)), rng.integers(0, 30, (50, 3))
    first, normals = corners_and_normals(points, triples)
    a, b, c = points[triples.T]
    np.testing.assert_array_equal(first, a)
    np.testing.assert_array_equal(normals, np.cross(b - a, c - a))


@pytest.mark.parametrize("spread", [0.2, 1e-9, 1e6])
def test_voxels(spread: float, rng: np.random.Generator) -> None:
    points = rng.uniform(-spread, spread, (500, 3))
    low, high = corners(points)
    np.testing.assert_array_equal([low, high], [points.min(axis=0), points.max(axis=0)])
    means, voxel = voxel_means(points, 0.03)
    assert sorted(set(voxel.tolist())) == list(range(len(means)))
    for k in range(len(means)):
        np.testing.assert_allclose(means[k], points[voxel == k].mean(axis=0), rtol=1e-9, atol=1e-12)
    local = own_frame(points)
    edge = max(0.03, 2 * np.abs(local).max() / 2e6)
    cells = np.unique(np.floor(local / edge + 0.5), axis=0, return_inverse=True)[1]
    np.testing.assert_array_equal(cells[:, None] == cells, voxel[:, None] == voxel)
    np.testing.assert_array_equal(thin(points, 0.03), means)


def test_the_same_points_share_a_voxel_in_any_frame(rng: np.random.Generator) -> None:
    points = rng.normal(size=(3000, 3)) * np.array([0.3, 0.2, 0.01])
    voxel = voxel_means(points, 0.03)[1]
    for motion in Rotation.random(5, random_state=1).as_matrix():
        moved = voxel_means(points @ motion.T + rng.uniform(-1, 1, 3), 0.03)[1]
        np.testing.assert_array_equal(moved, voxel)


@pytest.mark.parametrize("min_neighbours", [1, 3, 6])
def test_clusters_are_those_of_open3d(min_neighbours: int, rng: np.random.Generator) -> None:
    points = rng.uniform(0, 0.25, (700, 3))
    gap = 0.03
    centres, voxel = voxel_means(points, gap / 2)
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(centres))
    expected = np.asarray(cloud.cluster_dbscan(gap, min_neighbours))
    neighbours = (np.linalg.norm(centres[:, None] - centres, axis=2) < gap).sum(axis=1)
    dense = neighbours >= min_neighbours
    found = np.full(len(centres), -2)
    found[voxel] = cluster(points, gap, min_neighbours)
    np.testing.assert_array_equal(found < 0, expected < 0)
    a, b = found[dense], expected[dense]  # a border point may go to either of its clusters
    np.testing.assert_array_equal(a[:, None] == a, b[:, None] == b)
    assert len(set(a.tolist())) > 1 or min_neighbours == 1


def test_a_survey_of_heights(rng: np.random.Generator) -> None:
    count, rows, columns, edge = 400, 9, 12, 0.01
    points = np.column_stack(
        [
            rng.uniform(-0.01, 0.09, count),
            rng.uniform(-0.01, 0.12, count),
            rng.uniform(-0.02, 0.03, count),
        ]
    )
    viewpoint = np.array([0.0, 0.0, 0.5])
    noise = np.array([0.4, 0.48, 0.55]), np.array([5e-4, 1e-3, 2e-3])
    plane = np.array([0.0, 0.0, 1.0]), 0.001
    cells, sums, above, close = survey(
        points, plane, viewpoint, noise, (0.001, 0.006, 0.004), np.eye(3)[:2] / edge, np.zeros(2),
        rows, columns,
    )  # fmt: skip
    heights = points[:, 2] + 0.001
    sigmas = np.interp(np.linalg.norm(points - viewpoint, axis=1), *noise)
    np.testing.assert_array_equal(above, heights > np.maximum(0.006, 8 * sigmas))
    np.testing.assert_array_equal(close, np.abs(heights) < np.maximum(0.004, 4 * sigmas))
    number, total = np.zeros((rows, columns)), np.zeros((rows, columns))
    for i in range(count):
        row, column = np.floor(points[i, :2] / edge).astype(int) + 1
        inside = 1 <= row < rows - 1 and 1 <= column < columns - 1
        if inside and heights[i] > -3 * sigmas[i] - 0.001:
            number[row, column] += 1
            total[row, column] += min(heights[i], max(0.006, 8 * sigmas[i]))
            assert cells[i] == row * columns + column
        else:
            assert cells[i] == 0
    np.testing.assert_array_equal(sums[:, :, 0], number)
    np.testing.assert_allclose(sums[:, :, 1], total, atol=1e-15)
    assert 0 < number.sum() < count
    assert 0 < above.sum() < (~close).sum() < count


def test_windows(rng: np.random.Generator) -> None:
    sums = np.zeros((14, 11, 2))
    sums[1:-1, 1:-1] = rng.uniform(0, 2, (12, 9, 2))
    sums[2:7, 2:7] = 0.0
    count, mean = window_means(sums)
    expected = [ndimage.convolve(sums[:, :, k], EIGHT, mode="constant") for k in (0, 1)]
    np.testing.assert_allclose(count[1:-1, 1:-1], expected[0][1:-1, 1:-1], atol=1e-14)
    ratio = expected[1] / np.maximum(expected[0], 1.0)
    np.testing.assert_allclose(mean[1:-1, 1:-1], ratio[1:-1, 1:-1], atol=1e-14)
    assert count[0].max() == mean[:, -1].max() == 0.0


def test_weak_patches_grow_from_sure_cells(rng: np.random.Generator) -> None:
    weak = np.zeros((40, 50), dtype=np.bool_)
    weak[1:-1, 1:-1] = rng.random((38, 48)) < 0.3
    sure = weak & (rng.random(weak.shape) < 0.02)
    patches, _ = ndimage.label(weak, EIGHT)
    expected = np.isin(patches, np.unique(patches[sure])) & weak
    np.testing.assert_array_equal(grow(sure, weak), expected)
    assert sure.sum() < expected.sum() < weak.sum()


def test_highest_around_and_points_over(rng: np.random.Generator) -> None:
    mean, kept = rng.uniform(0.1, 1, (12, 15)), np.zeros((12, 15), dtype=np.bool_)
    kept[1:-1, 1:-1] = rng.random((10, 13)) < 0.5
    peaks = ndimage.maximum_filter(np.where(kept, mean, 0.0), size=3, mode="constant")
    cells = np.flatnonzero(kept).astype(np.int32)
    np.testing.assert_array_equal(highest_around(cells, mean, kept), peaks.ravel()[cells])
    of_points = rng.integers(0, mean.size, 100).astype(np.int32)
    np.testing.assert_array_equal(
        points_over(of_points, kept), np.flatnonzero(kept.ravel()[of_points])
    )


def test_warming_up_compiles_every_kernel_and_requests_none() -> None:
    """One combination of types each, or processes could overwrite each other's cache entries."""
    program = """
import importlib, pkgutil
import services.perception as package
from services.perception.perceive import Perception
from tests.services.perception.scenes import small_view
from shared.schemas.scene import PerceiveRequest

modules = [importlib.import_module(f"services.perception.{m.name}")
           for m in pkgutil.iter_modules(package.__path__)]
kernels = {name: value for module in modules for name, value in vars(module).items()
           if hasattr(value, "signatures") and name != "value_at"}  # compiled with its callers
stage = Perception()
stage.warm_up()
print(len(kernels), {len(kernel.signatures) for kernel in kernels.values()})
shot = small_view()
found = stage.perceive(shot.request(target=(0.0, 0.0, 0.8)))
stage.perceive(PerceiveRequest(points=shot.cloud(), viewpoint=(0.0, 0.0, 0.01)))
stage.perceive(PerceiveRequest(points=found.object_points, input="object"))
print(len(kernels), {len(kernel.signatures) for kernel in kernels.values()})
"""
    run = subprocess.run(
        [sys.executable, "-c", program],
        cwd=PROJECT_ROOT,
        check=True,
        capture_output=True,
        text=True,
    )
    before, after = run.stdout.splitlines()
    assert before == after
    assert before.endswith("{1}")
    assert int(before.split()[0]) > 10
