"""Tensors of the Open Inference Protocol, in JSON and behind it."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
import pytest

from services.gateway.kserve.messages import InferInput
from services.gateway.kserve.tensors import DTYPES, TensorReader, pack, pack_text
from shared.errors import InvalidInput, PayloadTooLarge
from shared.wire.codec import validate


def read(datatype: str, shape: list[int], data: Any = None, raw: bytes | None = None) -> Any:
    fields: dict[str, Any] = {"name": "points", "datatype": datatype, "shape": shape}
    if raw is not None:
        fields["parameters"] = {"binary_data_size": len(raw)}
    if data is not None:
        fields["data"] = data
    reader = TensorReader(memoryview(raw or b""), 1000)
    found = reader.read(validate(InferInput, fields))
    reader.finish()
    return found


@pytest.mark.parametrize("datatype", DTYPES)
def test_bytes_there_and_back(rng: np.random.Generator, datatype: str) -> None:
    array = rng.integers(0, 2, (3, 4)).astype(DTYPES[datatype])
    found = read(datatype, [3, 4], raw=pack(array))
    assert found.dtype == np.dtype(DTYPES[datatype])
    np.testing.assert_array_equal(found, array)
    np.testing.assert_array_equal(read(datatype, [3, 4], array.tolist()), array)
    np.testing.assert_array_equal(read(datatype, [3, 4], array.ravel().tolist()), array)


def test_pack_is_little_endian_and_row_major() -> None:
    array = np.asfortranarray(np.array([[1, 2], [3, 4]], dtype=">i2"))
    assert pack(array) == struct.pack("<4h", 1, 2, 3, 4)


def test_texts() -> None:
    assert read("BYTES", [1], ["gießen"]) == ["gießen".encode()]
    assert read("BYTES", [2, 1], [["a"], ["b"]]) == [b"a", b"b"]
    assert read("BYTES", [2], raw=pack_text(b"a") + pack_text(b"")) == [b"a", b""]


def test_whole_numbers_do_for_floats_and_infinity_for_what_is_too_large() -> None:
    np.testing.assert_array_equal(read("FP32", [2], [1, 2]), [1, 2])
    assert np.isinf(read("FP32", [1], [1e300])[0])
    assert read("FP64", [0, 3], []).shape == (0, 3)


@pytest.mark.parametrize(
    ("datatype", "shape", "data", "raw", "told"),
    [
        ("FP32", [2, 3], [1, 2, 3, 4, 5], None, "6 elements, data holds 5"),
        ("FP32", [2], [[1], [1, 2]], None, "regular"),
        ("FP32", [1], ["1"], None, "does not hold FP32"),
        ("FP32", [1], None, None, "does not hold FP32"),
        ("FP32", [1], {"a": 1}, None, "does not hold FP32"),
        ("FP32", [1], [None], None, "does not hold FP32"),
        ("UINT8", [1], [1.5], None, "does not hold UINT8"),
        ("UINT8", [1], [256], None, "outside 0..255"),
        ("INT64", [1], [2**70], None, "INT64"),
        ("BOOL", [1], [1], None, "does not hold BOOL"),
        ("BYTES", [1], [1], None, "are texts"),
        ("BYTES", [2], ["a"], None, "2 elements, data holds 1"),
        ("FP32", [2], None, b"\0" * 7, "takes 8 bytes; binary_data_size is 7"),
        ("FP32", [2**40, 2**40], None, b"", None),
        ("FP64", [126], [0.0] * 126, None, None),
        ("BYTES", [1], None, b"\x09\0\0\0abc", "longer than what is there"),
        ("BYTES", [1], None, b"\x09\0", "longer than what is there"),
    ],
)
def test_what_is_wrong_is_named(
    datatype: str, shape: list[int], data: Any, raw: bytes | None, told: str | None
) -> None:
    if told is None:
        with pytest.raises(PayloadTooLarge, match="allowed are 1000"):
            read(datatype, shape, data, raw)
        return
    with pytest.raises(InvalidInput, match=told):
        read(datatype, shape, data, raw)


@pytest.mark.parametrize(
    ("parameters", "told"),
    [
        ({"binary_data_size": 9}, "8 bytes are left"),
        ({"binary_data_size": -1}, "8 bytes are left"),
        ({"binary_data_size": True}, "8 bytes are left"),
        ({"binary_data_size": "8"}, "8 bytes are left"),
        ({}, "8 bytes behind the JSON belong to no input"),
    ],
)
def test_sizes_that_lie(parameters: dict[str, Any], told: str) -> None:
    data = None if parameters else [1.0, 2.0]
    fields = {"name": "x", "datatype": "FP32", "shape": [2], "parameters": parameters}
    reader = TensorReader(memoryview(b"\0" * 8), 1000)

    def read_all() -> None:
        reader.read(validate(InferInput, {**fields, "data": data}))
        reader.finish()

    with pytest.raises(InvalidInput, match=told):
        read_all()


def test_data_twice() -> None:
    with pytest.raises(InvalidInput, match="as well"):
        read("FP32", [1], [1.0], b"\0" * 4)
