"""Datasets: the same bytes from any number of processes, whole files, nothing overwritten."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from experiments.catalogue import CATALOGUE
from experiments.dataset import (
    CLEAN,
    DEPTH_SCALE,
    NOISY,
    DatasetOptions,
    make_dataset,
    read_view,
    read_views,
    view_files,
)
from experiments.dataset.choice import chosen_objects
from experiments.dataset.output import claimed
from services.cli.dataset import dataset
from shared.errors import Conflict, InvalidInput, SpargeError
from shared.geometry.points import points_from_depth
from shared.geometry.se3 import inverse, transform_points
from tests.support.bricks import cuboid

OPTIONS = DatasetOptions(views=3, objects=("bottle1", "hammer1"), noise=True, seed=5)


def contents(folder: Path) -> dict[str, bytes]:
    """Every file of a dataset but the lock, by its path."""
    files = sorted(path for path in folder.rglob("*") if path.is_file() and path.name != ".lock")
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("dataset") / "new" / "views"
    make_dataset(made, OPTIONS)
    return made


def test_there_is_a_file_per_view_and_a_manifest(folder: Path) -> None:
    names = {
        f"{kind}/{name}/{number}.npz"
        for kind in (CLEAN, NOISY)
        for name in OPTIONS.objects
        for number in range(OPTIONS.views)
    }
    assert set(contents(folder)) == names | {"manifest.json"}
    manifest = json.loads((folder / "manifest.json").read_bytes())
    assert manifest["complete"] is True
    assert manifest["seed"] == 5
    assert manifest["options"]["views"] == 3
    assert manifest["depth_scale"] == 1e-4
    assert list(manifest["objects"]) == ["hammer1", "bottle1"]
    bottle = manifest["objects"]["bottle1"]
    assert bottle["class"] == "bottle"
    assert set(bottle["tasks"]) == set(next(read_views(folder / CLEAN)).tasks)


def test_both_kinds_show_the_same_scenes(folder: Path) -> None:
    for clean, noisy in zip(read_views(folder / CLEAN), read_views(folder / NOISY), strict=True):
        assert (clean.object_name, clean.number) == (noisy.object_name, noisy.number)
        np.testing.assert_array_equal(clean.camera_from_object, noisy.camera_from_object)
        both = (clean.depth > 0) & (noisy.depth > 0)
        error = noisy.depth[both].astype(float) - clean.depth[both]
        assert 5 < error.std() < 25  # 0.1 mm
        assert clean.table_height == (0.8, 1.0)[clean.number % 2]


def test_the_format_is_that_of_plain_numpy(folder: Path) -> None:
    """What other tools rely on, read without our reader."""
    with np.load(folder / CLEAN / "hammer1" / "0.npz", allow_pickle=False) as held:
        assert held["depth"].dtype == np.uint16
        assert held["depth"].shape == held["label"].shape == (480, 640)
        assert held["label"].dtype == np.uint8
        assert held["K"].shape == (3, 3)
        assert held["T_cam_obj"].shape == held["T_cam_world"].shape == (4, 4)
        assert float(held["table_height"]) == 0.8
        masks = np.unpackbits(held["regions"], axis=-1, count=640).astype(bool)
        for index, task in enumerate(held["tasks"].tolist()):
            assert isinstance(task, str)
            assert (masks[index] | (held["label"] != 2 + index)).all()


def test_other_objects_and_views_do_not_matter(folder: Path, tmp_path: Path) -> None:
    make_dataset(tmp_path / "few", DatasetOptions(views=2, objects=("bottle1",), seed=5))
    few, many = contents(tmp_path / "few" / CLEAN), contents(folder / CLEAN)
    assert few == {name: many[name] for name in few}
    assert len(few) == 2


def test_seeds_matter(folder: Path, tmp_path: Path) -> None:
    make_dataset(tmp_path / "other", DatasetOptions(views=1, objects=("bottle1",), seed=6))
    one, other = (
        read_view(each / CLEAN / "bottle1" / "0.npz") for each in (folder, tmp_path / "other")
    )
    assert not np.allclose(one.camera_from_object, other.camera_from_object)


def test_a_second_run_keeps_what_is_whole(folder: Path, tmp_path: Path) -> None:
    whole = contents(folder)
    copy = tmp_path / "copy"
    for name, content in whole.items():
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        (copy / name).write_bytes(content)
    victims = sorted((copy / CLEAN / "bottle1").iterdir())
    victims[0].unlink()
    victims[1].write_bytes(victims[1].read_bytes()[:1000])
    (copy / NOISY / "hammer1" / ".2.npz.part").write_bytes(b"half")
    reports: list[tuple[int, int]] = []
    summary = make_dataset(
        copy, OPTIONS, progress=lambda done, total: reports.append((done, total))
    )
    assert (summary.objects, summary.made, summary.kept) == (2, 2, 4)
    assert reports == [(4, 6), (5, 6), (6, 6)]
    assert contents(copy) == whole


def test_a_killed_run_goes_on_to_the_same_bytes(folder: Path, tmp_path: Path) -> None:
    """Killed with its work half done, as by the system; its workers end as well.

    Two processes begin and two others end what one made in the fixture.
    """
    out = tmp_path / "killed"
    code = (
        "import sys; from pathlib import Path\n"
        "from experiments.dataset import DatasetOptions, make_dataset\n"
        "if __name__ == '__main__':\n"
        "    names = ('bottle1', 'hammer1')\n"
        "    options = DatasetOptions(views=3, objects=names, noise=True, seed=5)\n"
        "    make_dataset(Path(sys.argv[1]), options, workers=2)\n"
    )
    script = tmp_path / "script.py"
    script.write_text(code)
    root = Path(__file__).parents[2]
    run = subprocess.Popen(
        [sys.executable, script, out], env={**os.environ, "PYTHONPATH": str(root)}
    )
    try:
        deadline = time.monotonic() + 60
        while len(list(out.glob(f"{NOISY}/*/*.npz"))) < 2 and time.monotonic() < deadline:
            time.sleep(0.005)
        workers = children(run.pid)
        assert workers
    finally:
        run.send_signal(signal.SIGKILL)
        run.wait()
    deadline = time.monotonic() + 10
    while any(running(pid) for pid in workers) and time.monotonic() < deadline:
        time.sleep(0.01)
    assert not any(running(pid) for pid in workers)
    assert json.loads((out / "manifest.json").read_bytes())["complete"] is False
    for path in out.glob("*/*/[!.]*"):
        read_view(path)  # what is there is whole
    summary = make_dataset(out, OPTIONS, workers=2)
    assert summary.made + summary.kept == 6
    assert 0 < summary.kept < 6
    assert contents(out) == contents(folder)


def children(pid: int) -> list[int]:
    held = Path(f"/proc/{pid}/task/{pid}/children").read_text()
    return [int(child) for child in held.split()]


def running(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except (FileNotFoundError, ProcessLookupError):
        return False
    return state != "Z"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (DatasetOptions(views=5, objects=OPTIONS.objects, noise=True, seed=5), "views is 3, not 5"),
        (DatasetOptions(views=3, objects=OPTIONS.objects, noise=True, seed=6), "seed is 5, not 6"),
        (DatasetOptions(views=3, objects=OPTIONS.objects, seed=5), "noise is True, not False"),
        (DatasetOptions(views=3, objects=("pan1",), noise=True, seed=5), "pan1 is only in one"),
    ],
)
def test_another_dataset_is_not_mixed_in(
    folder: Path, options: DatasetOptions, message: str
) -> None:
    before = contents(folder)
    with pytest.raises(InvalidInput, match=message):
        make_dataset(folder, options)
    assert contents(folder) == before


def test_a_dataset_of_changed_shapes_is_not_continued(folder: Path, tmp_path: Path) -> None:
    manifest = json.loads((folder / "manifest.json").read_bytes())
    manifest["objects"]["bottle1"]["geometry_sha256"] = "0"
    (tmp_path / "manifest.json").write_text(json.dumps(manifest))
    with pytest.raises(InvalidInput, match="object bottle1 differs in geometry_sha256"):
        make_dataset(tmp_path, OPTIONS)


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b'{"format": "other"}', b"\xff\xfe"])
def test_a_broken_manifest_is_named(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "manifest.json").write_bytes(content)
    with pytest.raises(InvalidInput, match=r"manifest\.json"):
        make_dataset(tmp_path, OPTIONS)


def test_an_unusable_folder_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine")
    with pytest.raises(InvalidInput, match="is a file"):
        make_dataset(tmp_path / "file", OPTIONS)
    with pytest.raises(InvalidInput, match="cannot write"):
        make_dataset(tmp_path / "file" / "inside", OPTIONS)
    with pytest.raises(InvalidInput, match="holds 'file' and no dataset"):
        make_dataset(tmp_path, OPTIONS)
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_only_one_writes_at_a_time(tmp_path: Path) -> None:
    with claimed(tmp_path), pytest.raises(Conflict, match="another process"):
        make_dataset(tmp_path, OPTIONS)
    with claimed(tmp_path):
        pass


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        ({"views": 0}, "views is 0"),
        ({"seed": -1}, "seed is -1"),
        ({"variants": -2}, "variants is -2"),
        ({"correlation_px": 1.0}, "ask for noise"),
        ({"noise": True, "correlation_px": float("nan")}, "correlation_px is nan"),
        ({"meshes": Path("objects.json"), "variants": 1}, "meshes have none"),
    ],
)
def test_options_are_checked(bad: dict[str, Any], message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        DatasetOptions(**bad)


def test_without_names_the_whole_catalogue_is_shown() -> None:
    assert [thing.name for thing in chosen_objects(DatasetOptions())] == list(CATALOGUE)


def test_an_unknown_object_lists_the_known() -> None:
    with pytest.raises(InvalidInput, match=r"teapot.*bottle1"):
        chosen_objects(DatasetOptions(objects=("bottle1", "teapot")))


def test_variants_come_with_their_class_and_do_not_depend_on_each_other() -> None:
    many = chosen_objects(DatasetOptions(objects=("hammer1", "bottle2"), variants=3))
    assert [thing.name for thing in many] == [
        "hammer1", "bottle2",
        "hammer-v0", "hammer-v1", "hammer-v2", "bottle-v0", "bottle-v1", "bottle-v2",
    ]  # fmt: skip
    (_, one) = chosen_objects(DatasetOptions(objects=("hammer2",), variants=1))
    np.testing.assert_array_equal(one.vertices, many[2].vertices)
    sizes = {round(float(np.ptp(thing.vertices, axis=0).max()), 6) for thing in many[2:5]}
    assert len(sizes) == 3
    other = chosen_objects(DatasetOptions(objects=("hammer1",), variants=1, seed=1))[1]
    assert not np.array_equal(other.vertices[:50], one.vertices[:50])


def label_file(folder: Path, **objects: Any) -> Path:
    """A label file beside an ASCII PLY of a brick 200 mm long, in millimetres."""
    mesh = cuboid((200.0, 60.0, 40.0))
    lines = [
        "ply", "format ascii 1.0", f"element vertex {len(mesh.vertices)}",
        "property float x", "property float y", "property float z",
        f"element face {len(mesh.faces)}", "property list uchar int vertex_indices", "end_header",
        *(" ".join(map(str, vertex)) for vertex in mesh.vertices.tolist()),
        *(f"3 {a} {b} {c}" for a, b, c in mesh.faces.tolist()),
    ]  # fmt: skip
    (folder / "brick.ply").write_text("\n".join(lines) + "\n")
    labels = folder / "objects.json"
    labels.write_text(json.dumps({"objects": objects}))
    return labels


def test_meshes_with_labels_are_shown_as_the_catalogue_is(tmp_path: Path) -> None:
    entry = {"file": "brick.ply", "scale": 0.001, "regions": {"lifting": ["x", "<", 50.0]}}
    labels = label_file(tmp_path, brick=entry, second=entry)
    make_dataset(tmp_path / "out", DatasetOptions(views=2, meshes=labels, objects=("brick",)))
    views = list(read_views(tmp_path / "out" / CLEAN))
    assert [(view.object_name, view.number) for view in views] == [("brick", 0), ("brick", 1)]
    for view in views:
        seen = points_from_depth(view.depth, view.intrinsics, DEPTH_SCALE)
        x = transform_points(inverse(view.camera_from_object), seen)[:, 0]
        held, rest = x[view.region("lifting").ravel()], x[(view.label == 3).ravel()]
        assert -0.1001 < held.min() < held.max() < 0.0502
        assert 0.0498 < rest.min() < rest.max() < 0.1001
    with pytest.raises(InvalidInput, match=r"no object 'pan1'.*brick, second"):
        chosen_objects(DatasetOptions(meshes=labels, objects=("pan1",)))
    with pytest.raises(InvalidInput, match="cannot be read"):
        chosen_objects(DatasetOptions(meshes=tmp_path / "none.json"))


def test_names_that_make_no_folder_are_refused(tmp_path: Path) -> None:
    entry = {"file": "brick.ply", "scale": 0.001, "regions": {"lifting": ["x", "<", 50.0]}}
    for name in ("../brick", ".hidden", "two words"):
        with pytest.raises(InvalidInput, match="cannot name a folder"):
            chosen_objects(DatasetOptions(meshes=label_file(tmp_path, **{name: entry})))


def test_the_command_takes_names_apart(tmp_path: Path) -> None:
    app = typer.Typer()
    app.command()(dataset)
    out = tmp_path / "out"
    command = [str(out), "--views", "1", "--objects", "bottle1", "spoon1", "--workers", "1"]
    for again in ("0 of them", "2 of them"):
        result = CliRunner().invoke(app, command)
        assert result.exit_code == 0, result.output
        assert f"2 objects, 2 views, {again}" in " ".join(result.output.split())
    assert {each.object_name for each in view_files(out / CLEAN)} == {"bottle1", "spoon1"}
    refused = CliRunner().invoke(app, [*command, "--seed", "1"])
    assert isinstance(refused.exception, SpargeError)
