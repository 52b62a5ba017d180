"""The parts that carry the numerics, each against what is known in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from services.perception.cloud import cluster, thin
from services.perception.noise import measure_noise
from services.perception.observation import observe
from services.perception.plane import measure_plane, refine
from services.perception.ransac import find_planes
from services.perception.settings import PerceptionSettings
from services.perception.tabletop import lay_out
from services.perception.things import things_of
from shared.geometry.rotation import unit
from shared.schemas.scene import PerceiveRequest

SETTINGS = PerceptionSettings()


def test_noise_is_measured_where_it_grows(rng: np.random.Generator) -> None:
    ranges = rng.uniform(0.5, 2.0, 40_000)
    heights = rng.normal(0, 0.001 * ranges**2)
    heights[:4000] += 0.02  # things on the surface
    profile = measure_noise(heights, ranges)
    for at in (0.7, 1.2, 1.8):
        assert profile.at(np.array([at]))[0] == pytest.approx(0.001 * at**2, rel=0.2)


def test_an_exact_surface_has_a_positive_deviation() -> None:
    profile = measure_noise(np.zeros(10), np.ones(10))
    assert profile.at(np.array([0.1, 5.0])).min() > 0


def test_refinement_recovers_the_plane_under_objects(rng: np.random.Generator) -> None:
    """A fifth of the points stands a few centimetres off, all on one side and in one corner."""
    normal = unit([0.1, -0.8, -0.6])
    basis = np.linalg.svd(normal[None])[2][1:]
    on = rng.uniform(-0.4, 0.4, (20_000, 2)) @ basis + 0.9 * -normal
    on += rng.normal(0, 0.001, (20_000, 1)) * normal
    off = rng.uniform(0.1, 0.3, (5000, 2)) @ basis - 0.9 * normal
    off += rng.uniform(0.003, 0.05, (5000, 1)) * normal
    points = np.vstack([on, off])
    view = observe(PerceiveRequest(points=points), "scene", 30, 10**6)
    first = next(find_planes(view, SETTINGS, np.random.default_rng(0)))
    plane = refine(first, points, SETTINGS)
    assert float(plane.normal @ normal) > np.cos(np.deg2rad(0.03))
    assert plane.offset == pytest.approx(0.9, abs=2e-4)
    assert plane.normal @ np.zeros(3) + plane.offset > 0  # the sensor is above


def test_three_planes_of_a_corner(rng: np.random.Generator) -> None:
    uv = rng.uniform(0, 0.5, (3, 3000, 2))
    faces = [np.insert(uv[k], k, 0.0, axis=1) for k in range(3)]
    cloud = np.vstack(faces) + np.array([0.2, 0.2, 0.5])
    view = observe(PerceiveRequest(points=cloud), "scene", 30, 10**6)
    normals = [plane.normal for plane in find_planes(view, SETTINGS, np.random.default_rng(0))]
    found = np.abs(np.array(normals[:3])).max(axis=1)
    np.testing.assert_allclose(found, 1.0, atol=1e-3)
    assert {int(np.argmax(np.abs(normal))) for normal in normals[:3]} == {0, 1, 2}


def test_clusters_part_at_the_gap(rng: np.random.Generator) -> None:
    blob = rng.uniform(0, 0.05, (2000, 3))
    apart = np.vstack([blob, blob + np.array([0.08, 0, 0])])
    labels = cluster(apart, 0.012, 3)
    assert len(set(labels[:2000])) == 1
    assert len(set(labels[2000:])) == 1
    assert labels[0] != labels[-1]
    close = np.vstack([blob, blob + np.array([0.052, 0, 0])])
    assert len(set(cluster(close, 0.012, 3))) == 1


def test_clusters_do_not_depend_on_the_order(rng: np.random.Generator) -> None:
    points = rng.uniform(0, 0.3, (800, 3))
    order = rng.permutation(800)
    straight, shuffled = cluster(points, 0.03, 2), cluster(points[order], 0.03, 2)
    same = straight[order][:, None] == straight[order][None]
    assert np.array_equal(same, shuffled[:, None] == shuffled[None])


def test_clusters_of_nothing() -> None:
    assert len(cluster(np.empty((0, 3)), 0.01, 3)) == 0
    assert thin(np.empty((0, 3)), 0.01).shape == (0, 3)


def test_things_come_largest_first(rng: np.random.Generator) -> None:
    points = rng.uniform(0, 1, (60, 3))
    labels = np.repeat([0, 1, -1, 2], [10, 30, 15, 5]).astype(np.int32)
    members = np.arange(60, dtype=np.intp)
    things = things_of(points, members, labels)
    assert [len(thing.members) for thing in things] == [30, 10, 5]
    np.testing.assert_array_equal(things[0].members, np.arange(10, 40))


@pytest.mark.parametrize(("height", "is_wall"), [(0.3, True), (0.0, False)])
def test_a_plane_along_the_edge_of_the_table_is_no_wall(height: float, is_wall: bool) -> None:
    """What lies on the table is in one plane with its edge; a wall stands out of it itself."""
    grid = np.linspace(-0.5, 0.5, 101)
    table = np.array([(x, y, 0.0) for x in np.arange(0, 0.5, 0.01) for y in grid])
    board = np.array([(0.3, y, z) for y in grid[45:56] for z in np.arange(0.01, 0.2, 0.01)])
    edge = np.array([(0.3, y, z) for y in grid for z in np.arange(0.0, height + 0.01, 0.01)])
    points = np.vstack([table, board, edge]) - np.array([0, 0, 1.0])
    view = observe(PerceiveRequest(points=points), "scene", 30, 10**6)
    level = next(find_planes(view, SETTINGS, np.random.default_rng(0)))
    across = np.vstack([board, edge]) - np.array([0, 0, 1.0])
    upright = measure_plane(np.array([-1.0, 0, 0]), 0.3, across, 0.1)
    assert upright is not None
    assert upright.length > SETTINGS.max_object_extent_m
    top = lay_out(level, [upright], view, SETTINGS)
    assert bool(top.furniture.any()) == is_wall
