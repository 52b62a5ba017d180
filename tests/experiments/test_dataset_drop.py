"""Where objects come to rest, against what symmetry and statics say."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from experiments.catalogue import CATALOGUE, CatalogueObject, Part, build
from experiments.catalogue.mass import mass_properties
from experiments.catalogue.model import Mesh
from experiments.catalogue.shapes import moved, revolve
from experiments.dataset.drop import body_of
from shared.errors import InvalidInput
from tests.support.bricks import brick, row

UPS = np.vstack([np.eye(3), -np.eye(3)])


def probabilities(thing: CatalogueObject, wobble_deg: float = 3.0) -> dict[tuple[int, ...], float]:
    """Probability by upward direction, rounded to whole coordinates."""
    found: dict[tuple[int, ...], float] = {}
    for pose in body_of(thing, wobble_deg).poses:
        up = tuple(int(each) for each in np.round(pose.up))
        found[up] = found.get(up, 0.0) + pose.probability
    return found


def test_a_die_is_fair() -> None:
    found = probabilities(brick((0.05, 0.05, 0.05)))
    assert set(found) == {tuple(up) for up in UPS.astype(int).tolist()}
    np.testing.assert_allclose(list(found.values()), 1 / 6, atol=1e-3)


def test_a_brick_prefers_its_large_faces() -> None:
    found = probabilities(brick((0.3, 0.2, 0.1)))
    assert found[0, 0, 1] == pytest.approx(found[0, 0, -1], abs=2e-3)
    assert found[0, 0, 1] > 2 * found[0, 1, 0] > 2 * found[1, 0, 0] > 0
    assert sum(found.values()) == pytest.approx(1)


def test_the_heavy_end_comes_down() -> None:
    heavy = {"light": 100.0, "heavy": 8000.0}
    found = probabilities(row((0.05, 0.05, 0.05), heavy, {"lifting": ("light",)}))
    assert found[-1, 0, 0] > 5 * found[1, 0, 0] > 0


def test_a_needle_stands_only_where_nothing_shakes_it() -> None:
    needle = brick((0.002, 0.002, 0.1))
    assert (0, 0, 1) in probabilities(needle, wobble_deg=0.0)
    assert (0, 0, 1) not in probabilities(needle)
    assert sum(probabilities(needle).values()) == pytest.approx(1)


def test_a_long_prism_cannot_rest_where_its_weight_is_not_held() -> None:
    """A slanted prism: its ends are facets, but it tips off them onto its sides."""
    slanted = brick((0.02, 0.02, 0.2))
    mesh = slanted.parts[0].meshes[0]
    leaning = Mesh(mesh.vertices + np.outer(mesh.vertices[:, 2], [0.8, 0, 0]), mesh.faces)
    found = body_of(CatalogueObject("prism", "", (Part("all", (leaning,)),), {})).poses
    assert all(abs(pose.up[2]) < 0.9 for pose in found)


def test_a_cylinder_rolls_to_no_side_in_particular() -> None:
    profile = [(0, 0), (0.03, 0), (0.03, 0.2), (0, 0.2)]
    tube = CatalogueObject("tube", "", (Part("all", (revolve(profile, 24),)),), {})
    lying = [pose for pose in body_of(tube).poses if abs(pose.up[2]) < 0.01]
    assert len(lying) == 24
    assert sum(pose.probability for pose in lying) > 0.8
    shares = [pose.probability for pose in lying]
    assert max(shares) == pytest.approx(min(shares), rel=0.02)


@pytest.mark.parametrize("name", ["pan1", "bottle2", "hammer3"])
def test_the_weight_is_above_what_touches(name: str) -> None:
    thing = build(name)
    centre = mass_properties(thing).centre
    for pose in body_of(thing).poses:
        turned = thing.vertices @ pose.table_from_object.T
        foot = (pose.table_from_object @ centre)[:2]
        touching = turned[turned[:, 2] < turned[:, 2].min() + 1e-3, :2]
        hull = ConvexHull(touching)
        assert (hull.equations[:, :2] @ foot + hull.equations[:, 2]).max() < 1e-3


def test_turning_the_object_turns_its_poses() -> None:
    thing = dataclasses.replace(build("hammer"), balance=(0.25, 0.004, 0.002))
    turn = Rotation.from_rotvec([0.3, -1.1, 0.7]).as_matrix()
    parts = tuple(
        dataclasses.replace(
            part, meshes=tuple(moved(mesh, (0.1, 0.2, 0.3), turn) for mesh in part.meshes)
        )
        for part in thing.parts
    )
    x, y, z = turn @ np.array(thing.balance) + [0.1, 0.2, 0.3]
    turned = dataclasses.replace(thing, parts=parts, balance=(x, y, z))
    assert len(body_of(thing).poses) > 2
    for one, other in zip(body_of(thing).poses, body_of(turned).poses, strict=True):
        np.testing.assert_allclose(turn @ one.up, other.up, atol=1e-6)
        assert one.probability == pytest.approx(other.probability, abs=2e-3)


def test_every_object_has_poses() -> None:
    for name in CATALOGUE:
        poses = body_of(build(name)).poses
        assert sum(pose.probability for pose in poses) == pytest.approx(1), name
        assert list(poses) == sorted(poses, key=lambda pose: -pose.probability)


def test_a_scan_with_holes_rests_by_its_hull() -> None:
    """Open surfaces that enclose nothing: the hull's centroid stands for the centre of mass."""
    solid = brick((0.3, 0.2, 0.1))
    mesh = solid.parts[0].meshes[0]
    inside_out = Mesh(mesh.vertices, mesh.faces[:, ::-1].copy())
    scan = CatalogueObject("scan", "", (Part("all", (inside_out,)),), {})
    for up, share in probabilities(solid).items():
        assert probabilities(scan)[up] == pytest.approx(share, abs=5e-3)


@pytest.mark.parametrize("size", [(0.1, 0.1, 0.0), (0.1, 0.0, 0.0), (np.nan, 0.1, 0.1)])
def test_what_has_no_volume_is_refused(size: tuple[float, float, float]) -> None:
    with pytest.raises(InvalidInput, match="sheet"):
        body_of(brick(size, "sheet"))
