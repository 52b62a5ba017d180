"""The catalogue: closed meshes, labelled parts, and how the objects come to rest."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
import open3d as o3d
import pytest
from scipy.ndimage import label

from experiments.catalogue import (
    ALIASES,
    CATALOGUE,
    CLASSES,
    CatalogueObject,
    Part,
    build,
    mass_properties,
    resting_poses,
)
from experiments.catalogue.bottles import bottle
from experiments.catalogue.forms import curve, limb, plate, ring, rounded_box, shell
from experiments.catalogue.model import Mesh
from experiments.catalogue.resting import resting_pose
from experiments.catalogue.shapes import box, loft, moved, revolve, scaled, superellipse, sweep
from shared.geometry.rotation import frame_from_z

THESIS_CLASSES = ("pan", "ladle", "hammer", "spatula", "bottle")
NEW_CLASSES = ("knife", "scissors", "mug", "screwdriver", "box", "can", "bowl")
THESIS_TASK = {
    "pan": "cooking",
    "ladle": "scooping",
    "hammer": "hammering",
    "spatula": "turning",
    "bottle": "pouring",
    "knife": "cutting",
    "scissors": "cutting",
}
KNOWN_TASKS = {"cooking", "cutting", "hammering", "handover", "pouring", "scooping", "turning"}


def assert_watertight(mesh: Mesh) -> None:
    """Every edge borders two triangles, once in each direction, and the outside is outside."""
    start, end = mesh.faces.ravel(), np.roll(mesh.faces, -1, axis=1).ravel()
    count = len(mesh.vertices)
    there = np.sort(start.astype(np.int64) * count + end)
    back = np.sort(end.astype(np.int64) * count + start)
    assert (np.diff(there) > 0).all()
    np.testing.assert_array_equal(there, back)
    assert mesh.moments()[0] > 0
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    assert np.linalg.norm(np.cross(b - a, c - a), axis=1).min() > 0


def shadow(
    thing: CatalogueObject, axis: int, steps: int = 400
) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Return where rays along an axis hit the object, a margin around it."""
    vertices, faces = thing.vertices, thing.surface.faces
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(
        o3d.core.Tensor.from_numpy(vertices.astype(np.float32)),
        o3d.core.Tensor.from_numpy(faces.astype(np.uint32)),
    )
    low, high = vertices.min(axis=0) - 0.005, vertices.max(axis=0) + 0.005
    rays = np.zeros((steps, steps, 6), dtype=np.float32)
    one, other = (k for k in range(3) if k != axis)
    rays[..., one] = np.linspace(low[one], high[one], steps)[:, None]
    rays[..., other] = np.linspace(low[other], high[other], steps)[None, :]
    rays[..., axis], rays[..., 3 + axis] = low[axis], 1
    hit = scene.cast_rays(o3d.core.Tensor.from_numpy(rays))
    return np.asarray(np.isfinite(hit["t_hit"].numpy()))


def holes(thing: CatalogueObject, axis: int) -> int:
    """Return how many holes one can look through along an axis."""
    _, pieces = label(~shadow(thing, axis))
    return int(pieces) - 1  # one of them is the surroundings


def test_the_classes_of_the_thesis_have_three_objects_each() -> None:
    for class_name in THESIS_CLASSES:
        assert {f"{class_name}{number}" for number in (1, 2, 3)} <= CATALOGUE.keys()
    for class_name in NEW_CLASSES:
        assert f"{class_name}1" in CATALOGUE
    assert {name.rstrip("0123456789") for name in CATALOGUE} == CLASSES.keys()


@pytest.mark.parametrize("name", CATALOGUE)
def test_every_mesh_is_watertight(name: str) -> None:
    for part in build(name).parts:
        for mesh in part.meshes:
            assert_watertight(mesh)


@pytest.mark.parametrize("name", CATALOGUE)
def test_regions_are_disjoint_and_said_for_known_tasks(name: str) -> None:
    """A label image tells one task per pixel, so no part may be held for two."""
    thing = build(name)
    assert thing.name == name
    assert thing.class_name == name[:-1]
    assert thing.description
    held = Counter(part for parts in thing.regions.values() for part in parts)
    assert max(held.values()) == 1
    assert "handover" in thing.tasks
    assert set(thing.tasks) | set(thing.not_afforded) <= KNOWN_TASKS
    assert thing.not_afforded
    own = THESIS_TASK.get(thing.class_name)
    if own is not None:
        assert thing.tasks == (own, "handover")
        assert held.keys() == set(thing.part_names)


@pytest.mark.parametrize("name", CATALOGUE)
def test_objects_have_the_size_of_real_ones(name: str) -> None:
    longest = float(np.ptp(build(name).vertices, axis=0).max())
    assert 0.10 < longest < 0.48


@pytest.mark.parametrize("name", CATALOGUE)
def test_the_surface_is_all_parts(name: str) -> None:
    thing = build(name)
    surface = thing.surface
    assert len(surface.part) == len(surface.faces)
    assert surface.faces.max() < len(surface.vertices)
    for index, part in enumerate(thing.parts):
        assert (surface.part == index).sum() == sum(len(mesh.faces) for mesh in part.meshes)
        corners = surface.vertices[surface.faces[surface.part == index]]
        wanted = np.concatenate([mesh.vertices[mesh.faces] for mesh in part.meshes])
        np.testing.assert_array_equal(corners, wanted)


@pytest.mark.parametrize("name", ["pan1", "pan2", "pan3", "mug1", "mug2", "bowl1", "bowl2"])
def test_vessels_are_open_and_have_walls(name: str) -> None:
    """Looked into from above, one sees the bottom; below it there is some thickness."""
    thing = build(name)
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(
        o3d.core.Tensor.from_numpy(thing.vertices.astype(np.float32)),
        o3d.core.Tensor.from_numpy(thing.surface.faces.astype(np.uint32)),
    )
    top = float(thing.vertices[:, 2].max())
    rays = np.array(
        [[0.002, 0.001, top + 0.1, 0, 0, -1], [0.002, 0.001, -0.1, 0, 0, 1]], dtype=np.float32
    )
    down, up = scene.cast_rays(o3d.core.Tensor.from_numpy(rays))["t_hit"].numpy()
    floor, underside = top + 0.1 - float(down), float(up) - 0.1
    assert 0.001 < floor < 0.15 * top
    assert underside < floor - 0.001


@pytest.mark.parametrize(
    ("name", "axis", "expected"),
    [("scissors1", 2, 2), ("scissors2", 2, 2), ("mug1", 1, 1), ("mug2", 1, 1), ("pan3", 2, 1),
     ("spatula3", 2, 5)],
)  # fmt: skip
def test_one_can_see_through_rings_and_slots(name: str, axis: int, expected: int) -> None:
    thing = build(name)
    if name == "spatula3":
        turn = frame_from_z((np.sin(np.radians(16)), 0, np.cos(np.radians(16))), x_hint=(1, 0, 0))
        parts = [
            replace(part, meshes=tuple(moved(mesh, (0, 0, 0), turn.T) for mesh in part.meshes))
            for part in thing.parts
        ]
        thing = replace(thing, parts=tuple(parts))
    assert holes(thing, axis) >= expected


def test_dimensions_are_parameters() -> None:
    assert np.ptp(bottle(diameter=0.09).vertices[:, 0]) == pytest.approx(0.09, rel=0.01)
    assert np.ptp(bottle().vertices[:, 0]) == pytest.approx(0.066, rel=0.01)


def test_a_class_alone_means_its_first_object() -> None:
    assert build("saucepan").name == "pan1"
    for class_name in CLASSES:
        assert build(class_name).name == f"{class_name}1"
    assert set(ALIASES.values()) <= CATALOGUE.keys()


# vertices and the sum of all coordinates in metres: the bundled views show these meshes
SAMPLE_MESHES = {
    "saucepan": (996, 188.8655560),
    "hammer": (968, 278.2816176),
    "bottle": (2058, 368.6723059),
    "spatula": (752, 80.9362755),
    "ladle": (1668, 140.4198911),
}


@pytest.mark.parametrize("name", SAMPLE_MESHES)
def test_objects_of_the_bundled_views_stay_as_they_are(name: str) -> None:
    count, total = SAMPLE_MESHES[name]
    vertices = build(name).vertices
    assert len(vertices) == count
    assert float(np.abs(vertices).sum()) == pytest.approx(total, abs=1e-6)


def test_an_unknown_name_lists_the_known_ones() -> None:
    with pytest.raises(ValueError, match="pan1, pan2"):
        build("teapot")


BRICK = Part("all", (box((0.3, 0.2, 0.1), (0, 0, 0), 1000.0),))


def test_an_object_that_contradicts_itself_is_refused() -> None:
    with pytest.raises(ValueError, match="no parts \\['lid'\\] for pouring"):
        CatalogueObject("brick", "", (BRICK,), {"pouring": ("lid",)})
    with pytest.raises(ValueError, match="no parts"):
        CatalogueObject("brick", "", (BRICK,), {"pouring": ()})
    with pytest.raises(ValueError, match="same name"):
        CatalogueObject("brick", "", (BRICK, BRICK), {})
    with pytest.raises(ValueError, match="afforded and not afforded"):
        CatalogueObject("brick", "", (BRICK,), {"pouring": ("all",)}, not_afforded=("pouring",))


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
    flat_ring = ring((1, 2, 3), (0.5, 0.5), (0.1, 0.1))
    assert_watertight(flat_ring)
    np.testing.assert_allclose(flat_ring.moments()[1], [1, 2, 3], atol=1e-9)
    carton = rounded_box((0.2, 0.1, 0.3), 0.002)
    assert_watertight(carton)
    assert carton.moments()[0] == pytest.approx(0.2 * 0.1 * 0.3, rel=0.01)
    np.testing.assert_allclose(carton.vertices.min(axis=0), [-0.1, -0.05, 0], atol=1e-12)
    np.testing.assert_allclose(carton.vertices.max(axis=0), [0.1, 0.05, 0.3], atol=1e-12)
    sheet = plate([(0, 0.1), (0.2, 0.1)], 0.002)
    assert sheet.moments()[0] == pytest.approx(0.1 * 0.2 * 0.002, rel=0.1)


def test_a_limb_with_round_ends_is_a_capsule() -> None:
    capsule = limb([(0, 0, 0), (1, 0, 0)], [(0, 0.2, 0.2), (1, 0.2, 0.2)], (0, 1, 0), exponent=2,
                   round_start=0.1, round_end=0.1, segments=64)  # fmt: skip
    assert_watertight(capsule)
    assert capsule.moments()[0] == pytest.approx(np.pi * 0.01 * (0.8 + 0.4 / 3), rel=0.02)
    np.testing.assert_allclose(np.ptp(capsule.vertices, axis=0), [1, 0.2, 0.2], rtol=0.01)


def test_a_curve_meets_its_ends_and_swings_nowhere() -> None:
    points = curve([(0, 0), (1, 0), (2, 1), (3, 1)], 50)
    np.testing.assert_allclose(points[[0, -1]], [(0, 0), (3, 1)])
    assert points[:, 1].min() >= 0
    assert points[:, 1].max() <= 1


def test_a_shell_has_its_wall_everywhere() -> None:
    angle = np.linspace(0, np.pi / 2, 60)
    half = np.column_stack([0.1 * np.sin(angle), -0.1 * np.cos(angle)])
    hollow = revolve(shell(half, 0.004), 128)
    assert_watertight(hollow)
    rim = np.pi**2 / 4 * 0.002 * 0.004 * 0.098 * 2  # half a ring on top
    wanted = 2 / 3 * np.pi * (0.1**3 - 0.096**3) + rim
    assert hollow.moments()[0] == pytest.approx(wanted, rel=0.02)


def test_moving_and_scaling() -> None:
    brick = box((0.3, 0.2, 0.1), (0, 0, 0))
    turned = moved(brick, (1, 2, 3), frame_from_z((1, 2, 2)))
    assert turned.moments()[0] == pytest.approx(brick.moments()[0])
    np.testing.assert_allclose(turned.moments()[1], [1, 2, 3], atol=1e-12)
    assert scaled(brick, (2, 3, 4)).moments()[0] == pytest.approx(24 * brick.moments()[0])


def test_loft_ends_are_closed() -> None:
    rim = np.column_stack([superellipse(1, 1), np.zeros(32)])
    assert_watertight(loft([rim, rim + np.array([0, 0, 1])]))


def test_a_brick_rests_on_its_six_faces_and_prefers_the_large_ones() -> None:
    poses = resting_poses(CatalogueObject("brick", "", (BRICK,), {}))
    ups = np.array([pose.up for pose in poses])
    likely = ups[:6]
    np.testing.assert_allclose(np.abs(likely).max(axis=1), 1, atol=1e-3)
    assert {int(np.abs(up).argmax()) for up in likely[:2]} == {2}
    assert sum(pose.probability for pose in poses) == pytest.approx(1)


@pytest.mark.parametrize("name", CATALOGUE)
def test_resting_poses_are_stable(name: str) -> None:
    """The centre of mass is above the ground that the object touches."""
    thing = build(name)
    poses = resting_poses(thing)
    assert poses
    for pose in poses[:3]:
        turned = thing.vertices @ pose.table_from_object.T
        centre = pose.table_from_object @ mass_properties(thing).centre
        on_ground = turned[turned[:, 2] < turned[:, 2].min() + 0.002, :2]
        for angle in np.linspace(0, np.pi, 24):
            direction = np.array([np.cos(angle), np.sin(angle)])
            reach = on_ground @ direction
            assert reach.min() - 2e-3 <= centre[:2] @ direction <= reach.max() + 2e-3


def test_a_pan_stands_and_a_bottle_lies_as_asked() -> None:
    assert resting_pose(build("saucepan"), (0, 0, 1)).up[2] > 0.999
    assert abs(resting_pose(build("bottle"), (1, 0, 0)).up[2]) < 0.1
