"""Tensors of the Open Inference Protocol <-> NumPy arrays, as JSON or as bytes behind it."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from services.gateway.kserve.messages import BINARY_SIZE, InferInput
from shared.errors import InvalidInput, PayloadTooLarge

DTYPES = {
    "BOOL": "?",
    **{f"UINT{bits}": f"<u{bits // 8}" for bits in (8, 16, 32, 64)},
    **{f"INT{bits}": f"<i{bits // 8}" for bits in (8, 16, 32, 64)},
    **{f"FP{bits}": f"<f{bits // 8}" for bits in (16, 32, 64)},
}
_FROM_JSON = {"b": "b", "u": "iu", "i": "iu", "f": "iuf"}
"""Which kinds of numbers in JSON a tensor of some kind may be written with."""

Array = NDArray[Any]


@dataclass
class TensorReader:
    """Reads the inputs of one request, in their order.

    Attributes
    ----------
    behind : memoryview
        The bytes behind the JSON that are not read yet.
    max_bytes : int
        Bound on the size of one tensor.
    """

    behind: memoryview
    max_bytes: int

    def read(self, given: InferInput) -> Array | list[bytes]:
        """Return a tensor in its shape; BYTES as a flat list.

        Raises
        ------
        InvalidInput
            Shape, type and data do not fit each other.
        PayloadTooLarge
            It is larger than allowed.
        """
        count = math.prod(given.shape)
        raw = self._take(given)
        if given.datatype == "BYTES":
            texts = _texts(given) if raw is None else _packed_texts(given, raw)
            _require_count(given, len(texts), count)
            return texts
        dtype = np.dtype(DTYPES[given.datatype])
        if count * dtype.itemsize > self.max_bytes:
            raise PayloadTooLarge(
                f"the input {given.name!r} claims {count * dtype.itemsize} bytes; allowed are "
                f"{self.max_bytes}",
                allowed=self.max_bytes,
            )
        if raw is not None:
            if len(raw) != count * dtype.itemsize:
                raise _wrong(
                    given,
                    f"shape {list(given.shape)} of {given.datatype} takes "
                    f"{count * dtype.itemsize} bytes; {BINARY_SIZE} is {len(raw)}",
                )
            return np.frombuffer(raw, dtype).reshape(given.shape)
        numbers = _numbers(given, dtype)
        _require_count(given, len(numbers), count)
        return numbers.reshape(given.shape)

    def finish(self) -> None:
        """Return if every byte was claimed by an input."""
        if self.behind:
            raise InvalidInput(
                f"{len(self.behind)} bytes behind the JSON belong to no input",
                field="inputs",
                found=len(self.behind),
                allowed=0,
            )

    def _take(self, given: InferInput) -> memoryview | None:
        size = given.parameters.get(BINARY_SIZE)
        if size is None:
            return None
        if given.data is not None:
            raise _wrong(given, f"it has data in JSON and {BINARY_SIZE} as well")
        if type(size) is not int or not 0 <= size <= len(self.behind):
            raise _wrong(
                given, f"{BINARY_SIZE} is {size!r}; {len(self.behind)} bytes are left in the body"
            )
        taken, self.behind = self.behind[:size], self.behind[size:]
        return taken


def pack(array: Array) -> bytes:
    """Return an array as the extension has it: row-major, little-endian."""
    return np.ascontiguousarray(array, array.dtype.newbyteorder("<")).tobytes()


def pack_text(text: bytes) -> bytes:
    """Return one element of BYTES: its length and itself."""
    return struct.pack("<I", len(text)) + text


def _numbers(given: InferInput, dtype: np.dtype[Any]) -> Array:
    try:
        found = np.asarray(given.data)
    except (ValueError, OverflowError):
        raise _wrong(given, "data is not a regular array of numbers") from None
    if found.size == 0 and given.data is not None:
        return np.empty(0, dtype)
    if found.dtype.kind not in _FROM_JSON[dtype.kind]:
        raise _wrong(given, f"data does not hold {given.datatype}, or is not a regular array")
    if dtype.kind in "iu":
        limits = np.iinfo(dtype)
        if int(found.min()) < limits.min or int(found.max()) > limits.max:
            raise _wrong(given, f"data holds values outside {limits.min}..{limits.max}")
    with np.errstate(over="ignore"):  # beyond single precision: infinite, which is no return
        return found.astype(dtype).ravel()


def _texts(given: InferInput) -> list[bytes]:
    flat = given.data if isinstance(given.data, list) else [given.data]
    while flat and isinstance(flat[0], list):
        flat = [each for row in flat if isinstance(row, list) for each in row]
    if not all(isinstance(each, str) for each in flat):
        raise _wrong(given, "data of BYTES are texts")
    return [each.encode(errors="replace") for each in flat]


def _packed_texts(given: InferInput, raw: memoryview) -> list[bytes]:
    texts = []
    while raw:
        length = int.from_bytes(raw[:4], "little")
        if len(raw) < 4 + length:
            raise _wrong(given, "an element of BYTES is longer than what is there")
        texts.append(bytes(raw[4 : 4 + length]))
        raw = raw[4 + length :]
    return texts


def _require_count(given: InferInput, found: int, count: int) -> None:
    if found != count:
        raise _wrong(given, f"shape {list(given.shape)} has {count} elements, data holds {found}")


def _wrong(given: InferInput, why: str) -> InvalidInput:
    return InvalidInput(f"the input {given.name!r} is not sound: {why}", field=given.name)
