"""Labelled views: true to the object, the same after a round trip, refused when broken."""

from __future__ import annotations

import dataclasses
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import open3d as o3d
import pytest

from experiments.camera import D435, StereoNoise, Table, region_masks, render
from experiments.catalogue import CatalogueObject, Part, build
from experiments.dataset import (
    DEPTH_SCALE,
    LabelledView,
    make_view,
    read_view,
    read_views,
    view_files,
)
from experiments.dataset.drop import body_of
from experiments.dataset.make import MIN_SEEN_PX
from experiments.dataset.parse import view_from_arrays
from experiments.dataset.scene import Scene, draw_scene
from shared.errors import InvalidInput
from shared.geometry.points import points_from_depth
from shared.geometry.se3 import inverse, transform_points
from shared.wire.npz import write_npz
from tests.support.bricks import brick, cuboid, row

Arrays = dict[str, np.ndarray[Any, Any]]


@pytest.fixture(scope="module")
def bottle_view() -> LabelledView:
    return make_view(body_of(build("bottle")), 1, seed=3)


def own_points(view: LabelledView) -> np.ndarray[Any, np.dtype[np.float64]]:
    """The view's points (H, W, 3) in the object's frame; NaN is no return."""
    seen = points_from_depth(view.depth, view.intrinsics, DEPTH_SCALE)
    return transform_points(inverse(view.camera_from_object), seen).reshape(*view.depth.shape, 3)


def distance_to_parts(
    thing: CatalogueObject, names: tuple[str, ...], points: np.ndarray[Any, np.dtype[np.float64]]
) -> np.ndarray[Any, np.dtype[np.float64]]:
    scene = o3d.t.geometry.RaycastingScene(nthreads=1)
    for part in thing.parts:
        for mesh in part.meshes if part.name in names else ():
            scene.add_triangles(
                o3d.core.Tensor.from_numpy(mesh.vertices.astype(np.float32)),
                o3d.core.Tensor.from_numpy(mesh.faces.astype(np.uint32)),
            )
    query = o3d.core.Tensor.from_numpy(points.astype(np.float32))
    return np.asarray(scene.compute_distance(query).numpy(), dtype=np.float64)


@pytest.mark.parametrize(("name", "number"), [("bottle", 0), ("saucepan", 1), ("scissors", 2)])
def test_labelled_points_lie_on_the_parts_that_they_name(name: str, number: int) -> None:
    thing = build(name)
    view = make_view(body_of(thing), number, seed=0)
    points = own_points(view)
    assert view.on_object.sum() > 500
    rounding = 0.5 * DEPTH_SCALE * 1.2 + 1e-6  # along the ray, which is longer than its depth
    for task in thing.tasks:
        on_region = points[view.region(task)]
        assert distance_to_parts(thing, thing.regions[task], on_region).max() < rounding
    assert np.isfinite(points[view.label > 0]).all()
    assert (view.label[view.depth == 0] == 0).all()
    in_world = transform_points(inverse(view.camera_from_world), _in_camera(view)[view.label == 1])
    on_top = in_world[:, 0] > Table().near + 1e-3  # the rest is its front
    np.testing.assert_allclose(in_world[on_top, 2], view.table_height, atol=rounding)


def _in_camera(view: LabelledView) -> np.ndarray[Any, np.dtype[np.float64]]:
    points = points_from_depth(view.depth, view.intrinsics, DEPTH_SCALE)
    return points.reshape(*view.depth.shape, 3)


def test_noisy_points_lie_about_the_parts(bottle_view: LabelledView) -> None:
    thing = build("bottle")
    noisy = bottle_view.with_noise(StereoNoise(), np.random.default_rng(0))
    lost = (bottle_view.depth > 0) & (noisy.depth == 0)
    assert 0 < lost.sum() < 0.02 * lost.size
    assert (noisy.label[lost] == 0).all()
    assert not noisy.regions[:, lost].any()
    np.testing.assert_array_equal(noisy.label[~lost], bottle_view.label[~lost])
    off = distance_to_parts(
        thing, thing.regions["pouring"], own_points(noisy)[noisy.region("pouring")]
    )
    sigma = StereoNoise().sigma_at_1m * (noisy.depth[noisy.on_object] * DEPTH_SCALE).max() ** 2
    assert 0.2 * sigma < off.mean() < 1.2 * sigma
    assert off.max() < 6 * sigma


def test_regions_may_overlap_and_leave_parts_out() -> None:
    parts = {"left": 1000.0, "middle": 1000.0, "right": 1000.0}
    regions = {"pouring": ("left", "middle"), "handover": ("middle",)}
    thing = row((0.05, 0.05, 0.05), parts, regions)
    for number in range(4):
        view = make_view(body_of(thing), number, seed=1)
        middle = view.region("pouring") & view.region("handover")
        np.testing.assert_array_equal(view.label == 2, view.region("pouring"))
        np.testing.assert_array_equal(view.region("handover"), middle)
        assert not (view.label == 3).any()
        assert (view.label == 4).sum() > 100
        assert not view.regions[:, view.label == 4].any()
        x = own_points(view)[..., 0]
        assert x[view.label == 4].min() > 0.075 - 1e-4
        assert x[middle].min() > 0.025 - 1e-4
        assert x[middle].max() < 0.075 + 1e-4


def test_views_depend_on_seed_object_and_number_alone() -> None:
    body = body_of(build("hammer"))
    one, same = make_view(body, 5, seed=7), make_view(body, 5, seed=7)
    assert write_npz(one.arrays()) == write_npz(same.arrays())
    for other in (make_view(body, 5, seed=8), make_view(body, 7, seed=7)):
        assert not np.allclose(one.camera_from_object, other.camera_from_object)


def test_every_region_is_seen() -> None:
    """A mug's handle is hidden behind it in a fifth of the scenes; those are drawn again."""
    body = body_of(build("mug1"))
    rng = np.random.default_rng(0)
    scenes = [draw_scene(body, number, rng) for number in range(8)]
    handle = body.thing.regions["pouring"]
    assert any(smallest_region(body.thing, scene) == 0 for scene in scenes), handle
    for number in range(8):
        assert make_view(body, number, seed=0).regions.sum(axis=(1, 2)).min() >= MIN_SEEN_PX


def smallest_region(thing: CatalogueObject, scene: Scene) -> int:
    seen = render(thing, scene.world_from_object, scene.table, D435, scene.world_from_camera)
    return int(region_masks(thing, seen).sum(axis=(1, 2)).min())


def test_a_region_that_never_shows_is_shown_as_much_as_it_can() -> None:
    """A core inside a brick: the view is made all the same, its region empty."""
    shell = brick((0.05, 0.05, 0.05))
    core = Part("core", (cuboid((0.01, 0.01, 0.01)),))
    regions = {"lifting": ("all",), "curing": ("core",)}
    thing = dataclasses.replace(shell, parts=(*shell.parts, core), regions=regions)
    view = make_view(body_of(thing), 0, seed=0)
    assert view.region("lifting").sum() > 100
    assert not view.region("curing").any()


def test_an_unknown_task_lists_the_known(bottle_view: LabelledView) -> None:
    with pytest.raises(InvalidInput, match="pouring"):
        bottle_view.region("hammering")


def saved(folder: Path, name: str, number: int, arrays: Arrays) -> Path:
    path = folder / name / f"{number}.npz"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(write_npz(arrays))
    return path


def test_what_is_written_is_read(tmp_path: Path, bottle_view: LabelledView) -> None:
    read = read_view(saved(tmp_path, "bottle1", 1, bottle_view.arrays()))
    for name in LabelledView.__dataclass_fields__:
        np.testing.assert_array_equal(getattr(read, name), getattr(bottle_view, name), name)


def test_views_come_by_object_and_number(tmp_path: Path, bottle_view: LabelledView) -> None:
    for name, number in (("pan", 10), ("pan", 9), ("bottle", 2)):
        saved(tmp_path, name, number, bottle_view.arrays())
    expected = [("bottle", 2), ("pan", 9), ("pan", 10)]
    assert [(v.object_name, v.number) for v in read_views(tmp_path)] == expected
    assert [(f.object_name, f.number) for f in view_files(tmp_path)] == expected


def test_masks_come_from_labels_where_a_folder_has_none(bottle_view: LabelledView) -> None:
    arrays = {name: value for name, value in bottle_view.arrays().items() if name != "regions"}
    view = view_from_arrays("bottle", 1, arrays)
    np.testing.assert_array_equal(view.regions, bottle_view.regions)


def without(name: str) -> Callable[[Arrays], Arrays]:
    return lambda arrays: {key: value for key, value in arrays.items() if key != name}


def with_(name: str, value: Callable[[Arrays], Any]) -> Callable[[Arrays], Arrays]:
    return lambda arrays: arrays | {name: np.asarray(value(arrays))}


@pytest.mark.parametrize(
    ("harm", "message"),
    [
        (without("depth"), "'depth' is missing"),
        (without("tasks"), "'tasks' is missing"),
        (without("T_cam_obj"), "'T_cam_obj' is missing"),
        (with_("depth", lambda a: a["depth"] * 1e-4), "'depth' is float64"),
        (with_("depth", lambda a: a["depth"][..., None]), "'depth' has shape"),
        (with_("depth", lambda a: a["depth"][:0]), "'depth' has shape"),
        (with_("label", lambda a: a["label"][:, 1:]), "'label' has shape"),
        (with_("label", lambda a: a["label"].astype(int)), "'label' is int64"),
        (with_("label", lambda a: np.full_like(a["label"], 5)), "goes up to 5"),
        (with_("label", lambda a: np.full_like(a["label"], 3)), "contradict"),
        (with_("regions", lambda a: a["regions"] | 255), "contradict"),
        (with_("regions", lambda a: a["regions"][:1]), "'regions' is uint8"),
        (with_("K", lambda a: np.full((3, 3), np.nan)), "'K' holds NaN"),
        (with_("K", lambda a: -a["K"]), "not positive"),
        (with_("tasks", lambda a: ["pouring", "pouring"]), "repeated"),
        (with_("tasks", lambda a: [1, 2]), "should be strings"),
        (with_("T_cam_obj", lambda a: 2 * a["T_cam_obj"]), "'T_cam_obj' is not a rigid"),
        (with_("T_cam_world", lambda a: np.diag([1.0, 1, -1, 1])), "not a rigid"),
        (with_("table_height", lambda a: [0.8, 1.0]), "'table_height' has shape"),
    ],
)
def test_a_broken_file_is_named_with_its_fault(
    tmp_path: Path,
    bottle_view: LabelledView,
    harm: Callable[[Arrays], Arrays],
    message: str,
) -> None:
    saved(tmp_path, "bottle", 0, bottle_view.arrays())
    path = saved(tmp_path, "bottle", 1, harm(bottle_view.arrays()))
    views = read_views(tmp_path)
    assert next(views).number == 0
    with pytest.raises(InvalidInput, match=message) as caught:
        next(views)
    assert str(path) in caught.value.message


@pytest.mark.parametrize("content", [b"", b"no archive", b"PK\x03\x04 cut"])
def test_what_is_no_archive_is_named(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "bottle" / "3.npz"
    path.parent.mkdir()
    path.write_bytes(content)
    with pytest.raises(InvalidInput, match=r"3\.npz"):
        read_view(path)


def test_a_truncated_or_pickled_file_is_named(tmp_path: Path, bottle_view: LabelledView) -> None:
    path = saved(tmp_path, "bottle", 3, bottle_view.arrays())
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(InvalidInput, match=r"3\.npz"):
        read_view(path)
    with zipfile.ZipFile(path, "w") as archive, archive.open("depth.npy", "w") as member:
        np.lib.format.write_array(member, np.array([{}], dtype=object), allow_pickle=True)
    with pytest.raises(InvalidInput, match=r"3\.npz.*pickled"):
        read_view(path)


def test_what_holds_no_views_says_so(tmp_path: Path, bottle_view: LabelledView) -> None:
    with pytest.raises(InvalidInput, match="not a folder"):
        view_files(tmp_path / "missing")
    with pytest.raises(InvalidInput, match="no <object>"):
        view_files(tmp_path)
    saved(tmp_path / "views_clean", "bottle", 0, bottle_view.arrays())
    with pytest.raises(InvalidInput, match=r"it holds the folders .*views_clean"):
        view_files(tmp_path)
    (tmp_path / "views_clean" / "bottle" / "first.npz").touch()
    with pytest.raises(InvalidInput, match=r"first\.npz: a view's file"):
        view_files(tmp_path / "views_clean")
    with pytest.raises(InvalidInput, match="No such file"):
        read_view(tmp_path / "bottle" / "0.npz")
