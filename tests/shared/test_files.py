"""Files from outside: what comes out of good ones, and how bad ones are refused."""

from __future__ import annotations

import io
import struct
import tracemalloc
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import open3d as o3d
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from shared.errors import (
    InvalidInput,
    MalformedRequest,
    PayloadTooLarge,
    UnsupportedMediaType,
)
from shared.schemas.scene import View
from shared.wire.files import EXTENSIONS, read_cloud_file
from shared.wire.npz import write_npz
from tests.support.cloud_files import pcd, ply, png, xyz_header

POINTS = np.random.default_rng(3).uniform(-1, 1, (60, 3)).astype(np.float32)
INTRINSICS = [[615.0, 0.0, 320.0], [0.0, 615.0, 240.0], [0.0, 0.0, 1.0]]
DEPTH = np.random.default_rng(4).integers(0, 2**16, (12, 17)).astype(np.uint16)
MAX_BYTES = 2**20


def open3d_file(folder: Path, extension: str, *, as_text: bool, compressed: bool) -> bytes:
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(POINTS.astype(np.float64)))
    cloud.normals = o3d.utility.Vector3dVector(np.tile([0.0, 0.0, 1.0], (len(POINTS), 1)))
    path = folder / f"cloud{extension}"
    assert o3d.io.write_point_cloud(path, cloud, write_ascii=as_text, compressed=compressed)
    return path.read_bytes()


def xyz_text() -> bytes:
    return "\n".join(" ".join(map(repr, row)) for row in POINTS.tolist()).encode()


def read_points(name: str, data: bytes) -> NDArray[np.float64]:
    points = read_cloud_file(name, data, max_unpacked_bytes=MAX_BYTES).points
    assert points is not None
    assert points.dtype == np.float64
    return points


@pytest.mark.parametrize("extension", [".ply", ".pcd"])
@pytest.mark.parametrize(
    ("as_text", "compressed"), [(True, False), (False, False), (False, True)], ids=str
)
def test_reads_what_open3d_writes(
    tmp_path: Path, extension: str, as_text: bool, compressed: bool
) -> None:
    data = open3d_file(tmp_path, extension, as_text=as_text, compressed=compressed)
    np.testing.assert_allclose(read_points(f"cloud{extension}", data), POINTS, atol=1e-6)


@pytest.mark.parametrize(
    ("kind", "dtype"),
    [("float", "f4"), ("double", "f8"), ("short", "i2"), ("uchar", "u1"), ("uint32", "u4")],
)
@pytest.mark.parametrize(
    ("encoding", "order"), [("binary_little_endian", "<"), ("binary_big_endian", ">")]
)
def test_ply_number_types_become_float64(kind: str, dtype: str, encoding: str, order: str) -> None:
    whole = np.arange(30).reshape(10, 3)
    data = ply(whole.astype(order + dtype).tobytes(), *xyz_header(10, kind), encoding=encoding)
    np.testing.assert_array_equal(read_points("a.PLY", data), whole)


def test_ply_passes_over_other_elements_and_properties() -> None:
    header = [
        "comment made by hand",
        "element camera 2",
        "property double focal",
        "element vertex 3",
        "property uchar red",
        "property float z",
        "property float y",
        "property float x",
        "element face 4000000000",
        "property list uint int vertex_indices",
    ]
    rows = np.zeros(3, dtype=[("red", "u1"), ("z", "<f4"), ("y", "<f4"), ("x", "<f4")])
    rows["x"], rows["y"], rows["z"] = POINTS[:3].T
    data = ply(b"\0" * 16 + rows.tobytes(), *header)
    np.testing.assert_array_equal(read_points("a.ply", data), POINTS[:3])


def test_ply_ascii_with_faces_and_windows_line_ends() -> None:
    header = [*xyz_header(2), "element face 1", "property list uchar int vertex_indices"]
    data = ply(b"0 1 2\n3 4 5\n2 0 1\n", *header, encoding="ascii").replace(b"\n", b"\r\n")
    np.testing.assert_array_equal(read_points("a.ply", data), [[0, 1, 2], [3, 4, 5]])


def test_pcd_field_with_count_and_unnamed_field() -> None:
    rows = np.zeros(60, dtype=[("a", "u1", 5), ("z", "<f4"), ("x", "<f8"), ("y", "<f4")])
    rows["x"], rows["y"], rows["z"] = POINTS.T
    changes = {"FIELDS": "_ z x y", "SIZE": "1 4 8 4", "TYPE": "U F F F", "COUNT": "5 1 1 1"}
    data = pcd(rows.tobytes(), "binary", 60, **changes)
    np.testing.assert_array_equal(read_points("a.pcd", data), POINTS)


def test_pcd_keeps_no_return_points() -> None:
    points = read_points("a.pcd", pcd(b"nan nan nan\n1 2 3\n", "ascii", 2, WIDTH="1", HEIGHT="2"))
    assert np.isnan(points[0]).all()
    np.testing.assert_array_equal(points[1], [1, 2, 3])


@pytest.mark.parametrize(
    "text",
    [
        b"1 2 3\n4 5 6\n",
        b"1,2,3\n4, 5, 6",
        b"# a comment\n\n1 2 3 255 0 0 # red\n4\t5\t6 0 0 0\r\n",
        b"// from a scanner\nX Y Z\n1 2 3\n4e0 5. 6",
    ],
)
def test_xyz_dialects(text: bytes) -> None:
    np.testing.assert_array_equal(read_points("a.xyz", text), [[1, 2, 3], [4, 5, 6]])


def test_files_without_points_are_empty_clouds() -> None:
    for name, data in {
        "a.xyz": b"# nothing\n",
        "a.ply": ply(b"", *xyz_header(0)),
        "b.ply": ply(b"", *xyz_header(0), encoding="ascii"),
        "a.pcd": pcd(b"", "binary_compressed", 0),
    }.items():
        assert read_points(name, data).shape == (0, 3)


def test_depth_png_and_npz_say_the_same() -> None:
    from_png = read_cloud_file("d.png", png(DEPTH), intrinsics=INTRINSICS, depth_scale=1e-4)
    archive = {
        "depth": DEPTH,
        "intrinsics": np.asarray(INTRINSICS),
        "depth_scale": np.float64(1e-4),
        "colors": np.zeros((12, 17, 3), np.uint8),
    }
    from_npz = read_cloud_file("d.npz", write_npz(archive))  # type: ignore[arg-type]
    for read in (from_png, from_npz):
        assert read.depth is not None
        assert read.depth.dtype == np.uint16
        np.testing.assert_array_equal(read.depth, DEPTH)
        view = View(**read.fields())
        assert view.depth_scale == 1e-4


def test_npz_takes_from_beside_what_it_lacks() -> None:
    data = write_npz({"depth": DEPTH, "depth_scale": np.asarray(1e-3)})
    read = read_cloud_file("d.npz", data, intrinsics=INTRINSICS, depth_scale=7.0)
    assert read.depth_scale == 1e-3
    np.testing.assert_array_equal(read.fields()["intrinsics"], INTRINSICS)


def test_signalling_nan_is_a_nan() -> None:
    row = struct.pack("<I2f", 0x7F800001, 1.0, 2.0)
    for name, data in {"a.ply": ply(row, *xyz_header(1)), "a.pcd": pcd(row, "binary", 1)}.items():
        assert np.isnan(read_points(name, data)[0, 0])


def test_npz_points() -> None:
    np.testing.assert_array_equal(read_points("a.npz", write_npz({"points": POINTS})), POINTS)


@pytest.mark.parametrize("name", ["a.stl", "cloud", "", ".ply.", "a.ply/b", "a\x00.gz"])
def test_unknown_types_list_the_known_ones(name: str) -> None:
    with pytest.raises(UnsupportedMediaType) as caught:
        read_cloud_file(name, b"1 2 3")
    assert all(extension in caught.value.message for extension in EXTENSIONS)


TRILLION = 10**12


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("a.ply", ply(b"", *xyz_header(TRILLION))),
        ("a.ply", ply(b"", *xyz_header(TRILLION), encoding="ascii")),
        ("a.ply", ply(b"\0" * 24, "element pad 9000000000", "property double w", *xyz_header(1))),
        ("a.ply", ply(b"", *xyz_header(40_000))),
        ("a.ply", ply(b"", *xyz_header(40_000), encoding="ascii")),
        ("a.pcd", pcd(b"", "binary", TRILLION)),
        ("a.pcd", pcd(b"", "ascii", TRILLION)),
        ("a.pcd", pcd(b"", "binary", 1, COUNT=f"1 1 {TRILLION}")),
        ("a.pcd", pcd(struct.pack("<II", 4, TRILLION % 2**32) + b"abcd", "binary_compressed", 40)),
        ("a.pcd", pcd(struct.pack("<II", 2**31, 480) + b"abcd", "binary_compressed", 40)),
    ],
)
def test_lying_headers_take_no_memory(name: str, data: bytes) -> None:
    tracemalloc.start()
    try:
        with pytest.raises((MalformedRequest, PayloadTooLarge, InvalidInput)):
            read_cloud_file(name, data, max_unpacked_bytes=MAX_BYTES)
        assert tracemalloc.get_traced_memory()[1] < 2**20
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize(
    ("name", "data", "hint"),
    [
        ("a.ply", ply(b"", "element face 0", "property list uchar int i"), "vertex"),
        ("a.ply", ply(b"\0" * 8, "element vertex 1", "property float x", "property float y"), "z"),
        (
            "a.ply",
            ply(
                b"\0" * 99,
                "element vertex 1",
                "property list uchar float x",
                "property float y",
                "property float z",
            ),
            "list",
        ),
        (
            "a.ply",
            ply(b"\0" * 99, "element face 1", "property list uint int i", *xyz_header(1)),
            "list",
        ),
        ("a.pcd", pcd(b"1 2 3\n", "ascii", 1, FIELDS="x y w"), "x, y, z"),
        ("a.pcd", pcd(b"1 2 3\n", "ascii", 1, FIELDS="x x z"), "x, y, z"),
        ("a.npz", write_npz({"cloud": POINTS}), "points"),
        ("a.npz", write_npz({"points": POINTS, "depth": DEPTH}), "points"),
        ("a.npz", write_npz({"points": POINTS[:, :2]}), "(N, 3)"),
        ("a.npz", write_npz({"points": POINTS.astype(complex)}), "real"),
        ("a.npz", write_npz({"points": np.full((4, 3), "a")}), "real"),
        ("a.npz", write_npz({"depth": DEPTH}), "intrinsics"),
        ("a.npz", write_npz({"depth": DEPTH, "intrinsics": np.eye(4)}), "(3, 3)"),
        ("a.npz", write_npz({"depth": DEPTH, "intrinsics": np.zeros((3, 3))}), "focal"),
        ("a.npz", write_npz({"depth": DEPTH, "intrinsics": np.eye(3)}), "depth_scale"),
        (
            "a.npz",
            write_npz({"depth": DEPTH, "intrinsics": np.eye(3), "depth_scale": np.asarray(np.inf)}),
            "depth_scale",
        ),
        ("a.npz", write_npz({"depth": DEPTH[0], "intrinsics": np.eye(3)}), "(H, W)"),
        ("a.png", png(DEPTH.astype(np.uint8)), "8-bit greyscale"),
        ("a.png", png(np.zeros((4, 4, 3), np.uint8)), "RGB"),
        ("a.png", png(DEPTH), "intrinsics"),
    ],
)
def test_files_that_hold_the_wrong_thing(name: str, data: bytes, hint: str) -> None:
    with pytest.raises(InvalidInput, match=hint.replace("(", r"\(").replace(")", r"\)")):
        read_cloud_file(name, data)


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("a.ply", b""),
        ("a.ply", b"solid cube"),
        ("a.ply", b"ply\n" + b"comment\n" * 2000),
        ("a.ply", b"ply\n" + b"a" * 2**20),
        ("a.ply", b"ply\nelement vertex 1\nend_header\n"),
        ("a.ply", ply(b"1 2 x\n", *xyz_header(1), encoding="ascii")),
        ("a.ply", ply(b"1 2\n    \n", *xyz_header(1), encoding="ascii")),
        ("a.ply", ply(b"      \n      \n", *xyz_header(1), encoding="ascii")),
        ("a.ply", ply(b"\0" * 99, *xyz_header(1), "property float x")),
        ("a.pcd", b"DATA ascii\n1 2 3\n"),
        ("a.pcd", pcd(b"1 2 3\n", "ascii", 2)),
        ("a.pcd", pcd(b"1 2 3\n", "ascii", 1, WIDTH="3")),
        ("a.pcd", pcd(b"1 2 3\n", "zstd", 1)),
        ("a.pcd", pcd(b"1 2 3\n", "ascii", 1, POINTS="-1")),
        ("a.pcd", pcd(b"1 2 3\n", "ascii", 1, TYPE="F F")),
        ("a.pcd", pcd(b"\0" * 12, "binary", 1, SIZE="4 4 3")),
        ("a.pcd", pcd(struct.pack("<II", 4, 12) + b"\xff\xff\xff\xff", "binary_compressed", 1)),
        ("a.xyz", b"1 2 3\n4 5\n"),
        ("a.xyz", b"one two three\n"),
        ("a.xyz", b"1 " * 2**17),
        ("a.xyz", b"#\n" * 2**17),
        ("a.npz", b"PK\x03\x04 not really"),
        ("a.png", b"\x89PNG\r\n\x1a\n"),
        ("a.png", png(DEPTH)[:-40]),
    ],
)
def test_files_that_cannot_be_parsed(name: str, data: bytes) -> None:
    with pytest.raises(MalformedRequest):
        read_cloud_file(name, data, intrinsics=INTRINSICS, depth_scale=1e-4)


def test_text_is_bounded_by_the_points_it_holds() -> None:
    with pytest.raises(PayloadTooLarge, match="100 points"):
        read_cloud_file("a.xyz", b"0 0 0\n" * 101, max_unpacked_bytes=2400)


def test_zip_bomb_is_not_unpacked() -> None:
    data = write_npz({"points": np.zeros((2**20, 3))}, compress=True)
    assert len(data) < 2**16
    with pytest.raises(PayloadTooLarge):
        read_cloud_file("a.npz", data, max_unpacked_bytes=MAX_BYTES)


def png_bomb(width: int, height: int) -> bytes:
    """A PNG file of a few bytes whose header claims this size."""

    def chunk(kind: bytes, body: bytes) -> bytes:
        return (
            struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
        )

    header = struct.pack(">IIBBBBB", width, height, 16, 0, 0, 0, 0)
    pixels = zlib.compress(b"\0" * 1000)
    return (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", pixels) + chunk(b"IEND", b"")
    )


@pytest.mark.parametrize("size", [(2**31 - 1, 2**31 - 1), (30_000, 30_000), (1, 2**31 - 1)])
def test_png_bomb_is_not_decoded(size: tuple[int, int]) -> None:
    with pytest.raises(PayloadTooLarge):
        read_cloud_file("a.png", png_bomb(*size), intrinsics=INTRINSICS, depth_scale=1e-4)


def lzma_npz() -> bytes:
    stream = io.BytesIO()
    array = io.BytesIO()
    np.save(array, POINTS)
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_LZMA) as archive:
        archive.writestr("points.npy", array.getvalue())
    return stream.getvalue()


SOUND: dict[str, Callable[[], bytes]] = {
    "binary.ply": lambda: ply(POINTS.tobytes(), *xyz_header(60)),
    "text.ply": lambda: ply(xyz_text(), *xyz_header(60), encoding="ascii"),
    "binary.pcd": lambda: pcd(POINTS.tobytes(), "binary", 60),
    "text.pcd": lambda: pcd(xyz_text(), "ascii", 60),
    "text.xyz": xyz_text,
    "points.npz": lambda: write_npz({"points": POINTS}, compress=True),
    "lzma.npz": lzma_npz,
    "depth.npz": lambda: write_npz({"depth": DEPTH, "intrinsics": np.asarray(INTRINSICS)}),
    "depth.png": lambda: png(DEPTH),
}


def answers_or_refuses(name: str, data: bytes) -> None:
    """The law of this module: a sound value, or an error of the tree that is not a 500."""
    try:
        read = read_cloud_file(
            name, data, intrinsics=INTRINSICS, depth_scale=1e-4, max_unpacked_bytes=MAX_BYTES
        )
    except (MalformedRequest, InvalidInput, PayloadTooLarge, UnsupportedMediaType):
        return
    assert (read.points is None) != (read.depth is None)
    if read.points is not None:
        assert read.points.shape[1:] == (3,)


@pytest.mark.parametrize("extension", EXTENSIONS)
@settings(max_examples=60, deadline=None)
@given(data=st.binary(max_size=400))
def test_random_bytes(extension: str, data: bytes) -> None:
    answers_or_refuses(f"a{extension}", data)


@pytest.mark.parametrize("name", SOUND)
@settings(max_examples=60, deadline=None)
@given(share=st.floats(0, 1))
def test_truncations(name: str, share: float) -> None:
    data = SOUND[name]()
    answers_or_refuses(name, data[: int(share * len(data))])


@pytest.mark.parametrize("name", SOUND)
@settings(max_examples=150, deadline=None)
@given(
    changes=st.lists(
        st.tuples(st.floats(0, 1, exclude_max=True), st.binary(max_size=6), st.integers(0, 6)),
        min_size=1,
        max_size=4,
    ),
    in_header=st.booleans(),
)
def test_mutations(name: str, changes: list[tuple[float, bytes, int]], in_header: bool) -> None:
    data = SOUND[name]()
    for place, added, removed in changes:
        at = int(place * min(len(data), 200 if in_header else len(data)))
        data = data[:at] + added + data[at + removed :]
    answers_or_refuses(name, data)


@pytest.fixture(scope="module")
def compressed_pcd(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    folder = tmp_path_factory.mktemp("pcd")
    return open3d_file(folder, ".pcd", as_text=False, compressed=True)


@settings(max_examples=150, deadline=None)
@given(at=st.integers(0, 2000), byte=st.integers(0, 255))
def test_damaged_compressed_pcd(compressed_pcd: bytes, at: int, byte: int) -> None:
    data = bytearray(compressed_pcd)
    data[at % len(data)] = byte
    answers_or_refuses("a.pcd", bytes(data))
