"""Mass and balance: closed forms, and overlaps that count once."""

from __future__ import annotations

import numpy as np
import pytest

from experiments.catalogue import CATALOGUE, CatalogueObject, Part, build, mass_properties
from experiments.catalogue.mass import solid_properties
from experiments.catalogue.model import Mesh
from experiments.catalogue.shapes import moved, revolve
from shared.geometry.rotation import frame_from_z


def block(size: tuple[float, float, float], low: tuple[float, float, float]) -> Mesh:
    """Return an exact cuboid."""
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)])
    faces = [
        [0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
        [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5],
    ]  # fmt: skip
    return Mesh(corners * np.array(size) + np.array(low), np.array(faces, dtype=np.int32))


def test_a_block_weighs_what_it_should() -> None:
    found = solid_properties([block((0.3, 0.2, 0.1), (1, 2, 3))], [700.0])
    assert found.mass == pytest.approx(700 * 0.006, rel=1e-4)
    np.testing.assert_allclose(found.centre, [1.15, 2.1, 3.05], atol=1e-5)


def test_overlaps_count_once_and_belong_to_the_densest() -> None:
    wood, steel = block((0.2, 0.1, 0.1), (0, 0, 0)), block((0.2, 0.1, 0.1), (0.1, 0, 0))
    for meshes, densities in (([wood, steel], [500.0, 2000.0]), ([steel, wood], [2000.0, 500.0])):
        found = solid_properties(meshes, densities)
        assert found.mass == pytest.approx(500 * 0.001 + 2000 * 0.002, rel=5e-3)
        wanted = (0.5 * 0.05 + 4.0 * 0.2) / 4.5
        np.testing.assert_allclose(found.centre, [wanted, 0.05, 0.05], atol=5e-4)


def test_the_inside_of_a_vessel_is_empty() -> None:
    pot = revolve([(0, 0), (0.1, 0), (0.1, 0.2), (0.09, 0.2), (0.09, 0.01), (0, 0.01)], 256)
    found = solid_properties([pot], [1000.0])
    wanted = 1000 * np.pi * (0.01 * 0.2 - 0.0081 * 0.19)
    assert found.mass == pytest.approx(wanted, rel=0.01)


def test_turning_an_object_turns_its_centre() -> None:
    hammer = build("hammer2")
    turn = frame_from_z((1, 2, 2))
    meshes = [mesh for part in hammer.parts for mesh in part.meshes]
    densities = [part.density for part in hammer.parts for _ in part.meshes]
    turned = [moved(mesh, (0.1, 0.2, 0.3), turn) for mesh in meshes]
    one, other = solid_properties(meshes, densities), solid_properties(turned, densities)
    assert other.mass == pytest.approx(one.mass, rel=0.01)
    np.testing.assert_allclose(other.centre, turn @ one.centre + [0.1, 0.2, 0.3], atol=5e-4)


def test_nothing_enclosed_has_no_mass() -> None:
    flat = Mesh(np.eye(3), np.array([[0, 1, 2]], dtype=np.int32))
    with pytest.raises(ValueError, match="enclose nothing"):
        solid_properties([flat], [1000.0])


@pytest.mark.parametrize("name", CATALOGUE)
def test_objects_weigh_what_real_ones_weigh(name: str) -> None:
    """And never more than the sum of their parts; a lid overlaps its box most."""
    thing = build(name)
    found = mass_properties(thing)
    assert 0.03 < found.mass < 3.5
    parts = sum(part.density * mesh.moments()[0] for part in thing.parts for mesh in part.meshes)
    assert 0.70 * parts < found.mass < 1.01 * parts


def test_an_object_that_knows_its_balance_keeps_it() -> None:
    part = Part("all", (block((0.3, 0.2, 0.1), (0, 0, 0)),), 1000.0)
    thing = CatalogueObject("brick", "", (part,), {}, balance=(0.1, 0.1, 0.02))
    found = mass_properties(thing)
    assert found.mass == pytest.approx(6.0, rel=1e-3)
    np.testing.assert_allclose(found.centre, [0.1, 0.1, 0.02])
    np.testing.assert_allclose(thing.centre_of_mass, found.centre)
