"""A user's own meshes: every kind of file, regions cut exactly, and clear refusals."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import open3d as o3d
import pytest

from experiments.catalogue import resting_poses
from experiments.catalogue.collada import read_collada
from experiments.catalogue.cutting import cut
from experiments.catalogue.mesh_file import read_mesh
from experiments.catalogue.mesh_folder import read_mesh_folder
from experiments.catalogue.mesh_labels import read_labels
from experiments.catalogue.model import Mesh
from shared.errors import InvalidInput
from tests.experiments.test_catalogue import assert_watertight

# a bar from (0, 0, 0) to (10, 2, 1), its faces counter-clockwise from outside
CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 2) for x in (0, 10)], dtype=float)
FACES = np.array(
    [
        [0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
        [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5],
    ]
)  # fmt: skip
REGIONS = {"pouring": ["x", "<", 6], "handover": ["x", ">", 6]}
LABEL: dict[str, Any] = {"file": "bar.ply", "scale": 0.01, "regions": REGIONS}

COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <library_geometries><geometry id="bar"><mesh>
  <source id="at"><float_array id="f" count="24">{numbers}</float_array><technique_common>
   <accessor source="#f" count="8" stride="3"/></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#at"/></vertices>
  {primitives}
 </mesh></geometry></library_geometries>
 <library_nodes><node id="half"><scale>0.5 0.5 0.5</scale>
  <instance_geometry url="#bar"/></node></library_nodes>
 <library_visual_scenes><visual_scene id="s">
  <node><translate>1 2 3</translate><rotate>0 0 1 90</rotate><node>
   <matrix>2 0 0 0  0 2 0 0  0 0 2 0  0 0 0 1</matrix>
   <instance_node url="#half"/></node></node>
 </visual_scene></library_visual_scenes>
 <scene>{scene}</scene>
</COLLADA>"""
SCENE = '<instance_visual_scene url="#s"/>'
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def words(values: Any) -> str:
    return " ".join(str(value) for value in np.asarray(values).ravel())


def collada(kind: str, scene: str = SCENE) -> str:
    """Return the bar as one kind of primitive; every corner has a normal's index beside it."""
    inputs = (
        '<input semantic="NORMAL" source="#v" offset="0"/>'
        '<input semantic="VERTEX" source="#v" offset="1"/>'
    )
    if kind == "triangles":
        rows = [words(np.column_stack([0 * FACES.ravel(), FACES.ravel()]))]
    else:
        rows = [words(np.column_stack([np.zeros(4, int), quad])) for quad in QUADS]
    if kind == "polylist":
        rows = [" ".join(rows)]
        inputs += "<vcount>4 4 4 4 4 4</vcount>"
    if kind == "tristrips":
        rows = [words([0, q[0], 0, q[1], 0, q[3], 0, q[2]]) for q in QUADS]
    runs = "".join(f"<p>{row}</p>" for row in rows)
    return COLLADA.format(
        numbers=words(CORNERS), primitives=f"<{kind}>{inputs}{runs}</{kind}>", scene=scene
    )


def write_mesh(path: Path, vertices: Any = CORNERS, faces: Any = FACES) -> None:
    if path.suffix == ".dae":
        path.write_text(collada("triangles", scene=""))
        return
    mesh = o3d.geometry.TriangleMesh(
        o3d.utility.Vector3dVector(np.asarray(vertices, dtype=float)),
        o3d.utility.Vector3iVector(np.asarray(faces)),
    )
    if path.suffix == ".stl":
        mesh.compute_triangle_normals()
    o3d.io.write_triangle_mesh(path, mesh)


def write_labels(folder: Path, entry: Any, name: str = "bar") -> Path:
    path = folder / "labels.json"
    path.write_text(json.dumps({"note": "a bar", "objects": {name: entry}}))
    return path


def bar(folder: Path, **changes: Any) -> Path:
    write_mesh(folder / "bar.ply")
    return write_labels(folder, LABEL | changes)


@pytest.mark.parametrize("suffix", [".ply", ".obj", ".stl", ".dae"])
def test_every_kind_of_mesh_makes_the_same_object(tmp_path: Path, suffix: str) -> None:
    (tmp_path / "meshes").mkdir()
    write_mesh(tmp_path / "meshes" / f"bar{suffix}")
    labels = write_labels(tmp_path, {"file": f"bar{suffix}", "scale": 0.01, "regions": REGIONS})
    thing = read_mesh_folder(labels)["bar"]
    assert thing.name == "bar"
    assert thing.tasks == ("pouring", "handover")
    assert thing.regions == {"pouring": ("pouring",), "handover": ("handover",)}
    low, high = thing.vertices.min(axis=0), thing.vertices.max(axis=0)
    np.testing.assert_allclose(low, [0, 0, 0], atol=1e-8)
    np.testing.assert_allclose(high, [0.1, 0.02, 0.01], atol=1e-8)
    pouring = thing.parts[thing.part_names.index("pouring")].meshes[0].vertices
    handover = thing.parts[thing.part_names.index("handover")].meshes[0].vertices
    assert pouring[:, 0].max() == pytest.approx(0.06)
    assert handover[:, 0].min() == pytest.approx(0.06)
    np.testing.assert_allclose(thing.centre_of_mass, [0.05, 0.01, 0.005], atol=1e-4)
    surface = thing.surface
    assert_watertight(Mesh(*_welded(surface.vertices, surface.faces)))
    assert len(resting_poses(thing)) == 6


def _welded(vertices: Any, faces: Any) -> tuple[Any, Any]:
    places, where = np.unique(np.round(vertices, 9), axis=0, return_inverse=True)
    return places, where.reshape(-1)[faces].astype(np.int32)


@pytest.mark.parametrize("kind", ["triangles", "polylist", "polygons", "trifans", "tristrips"])
def test_collada_primitives_and_nodes(tmp_path: Path, kind: str) -> None:
    """Nested nodes: half of twice the bar, turned by 90 degrees, then shifted."""
    path = tmp_path / "bar.dae"
    path.write_text(collada(kind))
    vertices, faces = read_collada(path)
    x, y, z = CORNERS.T
    turned = np.column_stack([1 - y, 2 + x, 3 + z])
    np.testing.assert_allclose(vertices, turned, atol=1e-12)
    assert len(faces) == 12
    assert Mesh(vertices, faces.astype(np.int32)).moments()[0] == pytest.approx(20)
    assert_watertight(Mesh(vertices, faces.astype(np.int32)))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<COLLADA", "cannot be read as COLLADA"),
        ("<html/>", "root element is 'html'"),
        (collada("triangles").replace("#half", "#gone"), "'#gone', which is not in the file"),
        (collada("triangles").replace("scale>", "skew>"), "'skew' is not supported"),
        (collada("triangles").replace("0 1 0 4", "0 1 0 99"), "points that do not exist"),
        (collada("triangles").replace("#half", "#loop").replace('id="half"', 'id="loop"').replace(
            '<instance_geometry url="#bar"/>', '<instance_node url="#loop"/>'), "50 deep"),
        (collada("triangles").replace("10.0", "ten"), "cannot be read as COLLADA"),
    ],
)  # fmt: skip
def test_a_bad_collada_file_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "bar.dae"
    path.write_text(text)
    with pytest.raises(InvalidInput, match=message):
        read_mesh(path)


def test_overlapping_regions_and_the_rest(tmp_path: Path) -> None:
    labels = bar(
        tmp_path,
        regions={"pouring": ["x", "<", 6], "handover": ["x", "<", 4]},
        **{"class": "rod", "description": "a bar", "not_afforded": ["cutting"]},
    )
    thing = read_mesh_folder(labels, "objects")["bar"]
    assert set(thing.part_names) == {"pouring+handover", "pouring", "rest"}
    assert set(thing.regions["pouring"]) == {"pouring+handover", "pouring"}
    assert thing.regions["handover"] == ("pouring+handover",)
    assert (thing.class_name, thing.description) == ("rod", "a bar")
    assert thing.not_afforded == ("cutting",)


def test_an_inside_out_mesh_is_turned(tmp_path: Path) -> None:
    write_mesh(tmp_path / "bar.ply", faces=FACES[:, ::-1])
    vertices, faces = read_mesh(tmp_path / "bar.ply")
    assert Mesh(vertices, faces.astype(np.int32)).moments()[0] == pytest.approx(20)


def test_a_sheet_balances_about_its_area(tmp_path: Path) -> None:
    """A tray without thickness: it encloses nothing."""
    open_above = np.array([face for face in FACES if not set(face) <= {4, 5, 6, 7}])
    write_mesh(tmp_path / "tray.stl", faces=np.concatenate([open_above, open_above[:, ::-1]]))
    labels = write_labels(tmp_path, {"file": "tray.stl", "scale": 0.01, "regions": REGIONS})
    centre = read_mesh_folder(labels)["bar"].centre_of_mass
    height = 0.5 * (2 * 10 + 2 * 2) / (2 * 10 + 2 * 2 + 20)  # walls at half height, floor at 0
    np.testing.assert_allclose(centre, [0.05, 0.01, 0.01 * height], atol=1e-6)


@pytest.mark.parametrize("seed", range(3))
def test_a_cut_surface_stays_closed_and_keeps_its_volume(seed: int) -> None:
    rng = np.random.default_rng(seed)
    ball = o3d.geometry.TriangleMesh.create_sphere(1.0, 12)
    vertices, faces = np.asarray(ball.vertices), np.asarray(ball.triangles).astype(np.int64)
    whole = Mesh(vertices, faces.astype(np.int32)).moments()[0]
    for axis, value in (
        (2, 0.0),
        *zip(rng.integers(3, size=3), rng.uniform(-0.9, 0.9, 3), strict=True),
    ):
        vertices, faces = cut(vertices, faces, int(axis), float(value))
        along = vertices[faces][..., axis] - value
        assert ((along > -1e-9).all(axis=1) | (along < 1e-9).all(axis=1)).all()
    mesh = Mesh(vertices, faces.astype(np.int32))
    assert_watertight(mesh)
    assert mesh.moments()[0] == pytest.approx(whole)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"file": "gone.ply"}, "there is no mesh"),
        ({"file": "bar.step"}, "there is no mesh"),
        ({"scale": 0}, "objects.bar.scale: .* greater than 0, found 0"),
        ({"regions": {}}, "objects.bar.regions"),
        ({"regions": {"pouring": ["w", "<", 1]}}, "pouring.*'x', 'y' or 'z'.*found 'w'"),
        ({"regions": {"pouring": ["x", "=", 1]}}, "pouring.*'<' or '>'.*found '='"),
        ({"regions": {"pouring": ["x", "<", "one"]}}, "pouring.*number.*'one'"),
        ({"regions": {"pouring": ["x", "<"]}}, "objects.bar.regions.pouring"),
        ({"regions": {"pouring": ["x", "<", -1]}}, "region for pouring is empty.*x = .* to"),
        ({"colour": "red"}, "objects.bar.colour: Extra inputs"),
        ({"not_afforded": ["pouring"]}, "afforded and not afforded"),
    ],
)
def test_a_bad_label_is_refused(tmp_path: Path, changes: dict[str, Any], message: str) -> None:
    labels = bar(tmp_path, **changes)
    with pytest.raises(InvalidInput, match=message):
        read_mesh_folder(labels)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "is not JSON"),
        ("[1, 2]", "has no objects"),
        ('{"note": "nothing"}', "has no objects"),
        ('{"objects": {"bar": 3}}', "objects.bar: "),
        (json.dumps({"one": {"bar": LABEL}, "two": {"bar": LABEL}}), "two objects"),
    ],
)
def test_a_bad_label_file_is_refused(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "labels.json").write_text(text)
    with pytest.raises(InvalidInput, match=message):
        read_labels(tmp_path / "labels.json")


def test_a_missing_label_file_or_split_is_said(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="cannot be read: No such file"):
        read_mesh_folder(tmp_path / "gone.json")
    with pytest.raises(InvalidInput, match="no split 'test'; it has objects"):
        read_labels(bar(tmp_path), "test")


@pytest.mark.parametrize("suffix", [".ply", ".obj", ".stl"])
def test_an_unreadable_mesh_is_refused(
    tmp_path: Path, suffix: str, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / f"bar{suffix}"
    path.write_bytes(b"\x00\x01 this is no mesh")
    with pytest.raises(InvalidInput, match="no triangles"):
        read_mesh(path)
    assert capfd.readouterr().out == ""


def test_meshes_of_no_use_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match=r"\.dae, \.obj, \.ply, \.stl can"):
        read_mesh(tmp_path / "bar.step")
    with pytest.raises(InvalidInput, match="there is no mesh"):
        read_mesh(tmp_path / "bar.ply")
    write_mesh(tmp_path / "point.ply", faces=[[0, 0, 0]])
    with pytest.raises(InvalidInput, match="no triangles of any size"):
        read_mesh(tmp_path / "point.ply")
    write_mesh(tmp_path / "flat.ply", vertices=CORNERS * [1, 1, 0])
    labels = write_labels(tmp_path, {"file": "flat.ply", "regions": REGIONS})
    with pytest.raises(InvalidInput, match="is flat"):
        read_mesh_folder(labels)
    write_mesh(tmp_path / "nan.ply", vertices=np.where(CORNERS == 10, np.nan, CORNERS))
    with pytest.raises(InvalidInput, match="not finite"):
        read_mesh(tmp_path / "nan.ply")
