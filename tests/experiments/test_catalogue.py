"""The catalogue: closed meshes, labelled parts, and how the objects come to rest."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from experiments.catalogue import CATALOGUE, CatalogueObject, Part, build, resting_poses
from experiments.catalogue.model import Mesh
from experiments.catalogue.resting import resting_pose
from experiments.catalogue.shapes import box, loft, moved, revolve, scaled, superellipse, sweep
from shared.geometry.rotation import frame_from_z


def assert_watertight(mesh: Mesh) -> None:
    """Every edge borders two triangles, once in each direction, and the outside is outside."""
    edges = Counter(
        (int(a), int(b))
        for face in mesh.faces
        for a, b in zip(face, np.roll(face, -1), strict=True)
    )
    assert set(edges.values()) == {1}
    assert all((b, a) in edges for a, b in edges)
    assert mesh.moments()[0] > 0
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    assert np.linalg.norm(np.cross(b - a, c - a), axis=1).min() > 0


@pytest.mark.parametrize("name", CATALOGUE)
def test_every_mesh_is_watertight(name: str) -> None:
    for part in build(name).parts:
        for mesh in part.meshes:
            assert_watertight(mesh)


@pytest.mark.parametrize("name", CATALOGUE)
def test_every_part_is_held_for_one_task(name: str) -> None:
    thing = build(name)
    assert thing.name == name
    held = Counter(part for parts in thing.regions.values() for part in parts)
    assert held == Counter(part.name for part in thing.parts)
    assert "handover" in thing.tasks


@pytest.mark.parametrize("name", CATALOGUE)
def test_objects_have_the_size_of_real_ones(name: str) -> None:
    longest = float(np.ptp(build(name).vertices, axis=0).max())
    assert 0.15 < longest < 0.40


def test_dimensions_are_parameters() -> None:
    small = CATALOGUE["bottle"]()
    from experiments.catalogue.bottles import bottle

    assert np.ptp(bottle(diameter=0.09).vertices[:, 0]) == pytest.approx(0.09, rel=0.01)
    assert np.ptp(small.vertices[:, 0]) == pytest.approx(0.066, rel=0.01)


def test_an_unknown_name_lists_the_known_ones() -> None:
    with pytest.raises(ValueError, match="saucepan"):
        build("teapot")


def test_volumes_of_known_solids() -> None:
    square = superellipse(0.2, 0.1, 60, 64)
    bar = sweep([(0, 0, 0), (0, 0, 0.5)], [square, square], side=(1, 0, 0))
    assert bar.moments()[0] == pytest.approx(0.2 * 0.1 * 0.5, rel=0.01)
    cylinder = revolve([(0, 0), (0.1, 0), (0.1, 0.3), (0, 0.3)], 256)
    assert cylinder.moments()[0] == pytest.approx(np.pi * 0.01 * 0.3, rel=1e-3)
    np.testing.assert_allclose(cylinder.moments()[1], [0, 0, 0.15], atol=1e-12)
    angle = np.linspace(0, 2 * np.pi, 128, endpoint=False)
    circle = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    torus = sweep(circle, [superellipse(0.2, 0.2, 2, 64)] * 128, side=(0, 0, 1), closed=True)
    assert torus.moments()[0] == pytest.approx(2 * np.pi**2 * 0.01, rel=0.01)


def test_moving_and_scaling() -> None:
    brick = box((0.3, 0.2, 0.1), (0, 0, 0))
    turned = moved(brick, (1, 2, 3), frame_from_z((1, 2, 2)))
    assert turned.moments()[0] == pytest.approx(brick.moments()[0])
    np.testing.assert_allclose(turned.moments()[1], [1, 2, 3], atol=1e-12)
    assert scaled(brick, (2, 3, 4)).moments()[0] == pytest.approx(24 * brick.moments()[0])


def test_loft_ends_are_closed() -> None:
    ring = np.column_stack([superellipse(1, 1), np.zeros(32)])
    assert_watertight(loft([ring, ring + np.array([0, 0, 1])]))


def brick(size: tuple[float, float, float]) -> CatalogueObject:
    return CatalogueObject("brick", "", (Part("all", (box(size, (0, 0, 0), 1000.0),)),), {})


def test_a_brick_rests_on_its_six_faces_and_prefers_the_large_ones() -> None:
    poses = resting_poses(brick((0.3, 0.2, 0.1)))
    ups = np.array([pose.up for pose in poses])
    likely = ups[:6]
    np.testing.assert_allclose(np.abs(likely).max(axis=1), 1, atol=1e-3)
    assert {int(np.abs(up).argmax()) for up in likely[:2]} == {2}
    assert sum(pose.probability for pose in poses) == pytest.approx(1)


@pytest.mark.parametrize("name", CATALOGUE)
def test_resting_poses_are_stable(name: str) -> None:
    """The centre of mass is above the ground that the object touches."""
    thing = build(name)
    for pose in resting_poses(thing)[:3]:
        turned = thing.vertices @ pose.table_from_object.T
        centre = pose.table_from_object @ thing.centre_of_mass
        on_ground = turned[turned[:, 2] < turned[:, 2].min() + 0.002, :2]
        for angle in np.linspace(0, np.pi, 24):
            direction = np.array([np.cos(angle), np.sin(angle)])
            reach = on_ground @ direction
            assert reach.min() - 2e-3 <= centre[:2] @ direction <= reach.max() + 2e-3


def test_a_pan_stands_and_a_bottle_lies_as_asked() -> None:
    assert resting_pose(build("saucepan"), (0, 0, 1)).up[2] > 0.999
    assert abs(resting_pose(build("bottle"), (1, 0, 0)).up[2]) < 0.1
