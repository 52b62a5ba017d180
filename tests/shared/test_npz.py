"""npz archives from strangers: sound ones round trip, hostile ones are refused."""

from __future__ import annotations

import contextlib
import io
import zipfile

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from shared.errors import MalformedRequest, PayloadTooLarge
from shared.wire.npz import MAX_MEMBERS, read_npy, read_npz, write_npz

LIMIT = 10**6


def archive(members: dict[str, bytes]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as target:
        for name, content in members.items():
            target.writestr(name, content)
    return stream.getvalue()


def header(description: str) -> bytes:
    padded = description.encode().ljust(118) + b"\n"
    return b"\x93NUMPY\x01\x00" + len(padded).to_bytes(2, "little") + padded


@given(
    hnp.arrays(
        st.sampled_from(["float32", "float64", "uint16", "int32", "bool"]),
        hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=5),
    ),
    st.booleans(),
)
def test_arrays_round_trip(array: np.ndarray, compress: bool) -> None:
    (back,) = read_npz(write_npz({"a": array}, compress=compress), LIMIT).values()
    assert back.dtype == array.dtype
    np.testing.assert_array_equal(back, array)


def test_what_numpy_saves_is_read(rng: np.random.Generator) -> None:
    points, fortran = rng.normal(size=(7, 3)), np.asfortranarray(rng.normal(size=(4, 3)))
    stream = io.BytesIO()
    np.savez_compressed(stream, points=points, fortran=fortran, scalar=np.float64(1e-4))
    held = read_npz(stream.getvalue(), LIMIT)
    np.testing.assert_array_equal(held["points"], points)
    np.testing.assert_array_equal(held["fortran"], fortran)
    assert held["scalar"].item() == 1e-4


@given(
    hnp.arrays(
        st.sampled_from(["<f4", ">f8", "<i2", "|u1", "|b1", "<c16", "<U3"]),
        hnp.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=4),
    ),
    st.booleans(),
)
def test_headers_are_read_as_numpy_reads_them(array: np.ndarray, is_fortran: bool) -> None:
    stream = io.BytesIO()
    np.save(stream, np.asfortranarray(array) if is_fortran else array)
    stream.seek(0)
    expected, found = np.load(stream), read_npy(stream.getvalue(), "a")
    assert (found.shape, found.dtype) == (expected.shape, expected.dtype)
    np.testing.assert_array_equal(found, expected)


def test_the_same_arrays_give_the_same_bytes() -> None:
    arrays = {"a": np.arange(6.0).reshape(2, 3)}
    assert write_npz(arrays) == write_npz(arrays)


def test_pickled_objects_are_refused() -> None:
    stream = io.BytesIO()
    np.savez(stream, points=np.array([{"x": 1}], dtype=object))
    with pytest.raises(MalformedRequest, match="pickled"):
        read_npz(stream.getvalue(), LIMIT)


def test_a_zip_bomb_is_refused_before_it_unpacks() -> None:
    bomb = archive({"points.npy": b"\0" * 50_000_000})
    assert len(bomb) < 100_000
    with pytest.raises(PayloadTooLarge, match="50000000"):
        read_npz(bomb, LIMIT)


def test_too_many_members_are_refused() -> None:
    with pytest.raises(PayloadTooLarge):
        read_npz(archive({f"a{i}.npy": b"" for i in range(MAX_MEMBERS + 1)}), LIMIT)


@pytest.mark.parametrize(
    "shape", ["(1000000000000, 3)", "(-1, 3)", "(2, 3)", "(10**9,)", "'x'", "(1.5,)"]
)
def test_a_lying_header_is_refused(shape: str) -> None:
    lie = header(f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}") + b"\0" * 24
    with pytest.raises(MalformedRequest):
        read_npz(archive({"points.npy": lie}), LIMIT)


@pytest.mark.parametrize(
    "content", [b"", b"nonsense", b"\x93NUMPY\x09\x00", b"\x93NUMPY\x01\x00\xff"]
)
def test_a_member_without_a_header_is_refused(content: bytes) -> None:
    with pytest.raises(MalformedRequest):
        read_npz(archive({"points.npy": content}), LIMIT)


@given(st.data())
def test_damaged_archives_are_refused_or_read_and_nothing_else(data: st.DataObject) -> None:
    sound = bytearray(write_npz({"points": np.arange(30.0).reshape(10, 3)}, compress=True))
    cut = data.draw(st.integers(0, len(sound)))
    for position in data.draw(st.lists(st.integers(0, len(sound) - 1), max_size=4)):
        sound[position] ^= data.draw(st.integers(1, 255))
    with contextlib.suppress(MalformedRequest, PayloadTooLarge):
        read_npz(bytes(sound[:cut]), LIMIT)
