"""Points of a PCD file: its fields x, y, z, from bytes that nobody vouches for.

Source: "The PCD (Point Cloud Data) file format", pointclouds.org, version 0.7.
"""

from __future__ import annotations

import io
import itertools
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import lzf  # of python-neo-lzf
import numpy as np
from numpy.typing import NDArray

from shared.errors import InvalidInput, MalformedRequest, PayloadTooLarge
from shared.wire.text_table import data_lines, read_columns, read_line

MAX_HEADER_LINES = 200
_TYPES = {
    ("F", 4): "<f4",
    ("F", 8): "<f8",
    ("U", 1): "<u1",
    ("U", 2): "<u2",
    ("U", 4): "<u4",
    ("U", 8): "<u8",
    ("I", 1): "<i1",
    ("I", 2): "<i2",
    ("I", 4): "<i4",
    ("I", 8): "<i8",
}
_KEYS = ("FIELDS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "POINTS", "DATA")


@dataclass(frozen=True)
class _Field:
    name: str
    type: str
    count: int

    @property
    def size(self) -> int:
        return np.dtype(self.type).itemsize * self.count


@dataclass(frozen=True)
class _Header:
    fields: tuple[_Field, ...]
    points: int
    encoding: str

    @property
    def row_size(self) -> int:
        return sum(each.size for each in self.fields)

    def xyz(self) -> list[int]:
        """Return which of the fields are x, y and z."""
        names = [each.name for each in self.fields]
        wrong = [axis for axis in "xyz" if names.count(axis) != 1]
        if wrong:
            raise InvalidInput(
                f"the PCD file needs the fields x, y, z once each; it has {names[:20]}",
                field="file",
                found=names[:20],
                allowed=["x", "y", "z"],
            )
        indices = [names.index(axis) for axis in "xyz"]
        if any(self.fields[each].count != 1 for each in indices):
            raise InvalidInput("the PCD file's x, y, z must each be one number (COUNT 1)")
        return indices


def read_pcd(data: bytes, max_unpacked_bytes: int) -> NDArray[np.float64]:
    """Return the points (N, 3) of a PCD file, in the file's own unit.

    Reads ascii, binary and binary_compressed. Other fields are passed over.

    Raises
    ------
    MalformedRequest
        Not a PCD file, truncated, or its header claims more than it holds.
    InvalidInput
        It has no fields x, y, z.
    PayloadTooLarge
        The file would unpack to more than `max_unpacked_bytes`.
    """
    stream = io.BytesIO(data)
    header = _read_header(stream)
    columns = header.xyz()
    unpacked = header.points * max(header.row_size, 24)
    if unpacked > max_unpacked_bytes:
        raise PayloadTooLarge(
            f"the PCD file claims {header.points} points ({unpacked} bytes), "
            f"allowed are {max_unpacked_bytes} bytes",
            found=unpacked,
            allowed=max_unpacked_bytes,
        )
    if header.points == 0:
        return np.empty((0, 3))
    if header.encoding == "ascii":
        return _read_ascii(stream, header, columns, max_unpacked_bytes)
    body = data[stream.tell() :]
    if header.encoding == "binary":
        return _read_binary(body, header, columns)
    return _read_compressed(body, header, columns)


def _read_header(stream: io.BytesIO) -> _Header:
    entries: dict[str, list[str]] = {}
    for _ in range(MAX_HEADER_LINES):
        line = read_line(stream, "the PCD file")
        if not line:
            break
        match line.split():
            case [key, *values] if key in _KEYS and key not in entries:
                entries[key] = values
                if key == "DATA":
                    return _build_header(entries)
            case [] | ["VERSION" | "VIEWPOINT", *_]:
                pass
            case [mark, *_] if mark.startswith("#"):
                pass
            case _:
                shown = line[:80].strip()
                raise MalformedRequest(
                    f"the PCD header has a line that is not understood: {shown!r}"
                )
    raise MalformedRequest("the file has no PCD header that ends with 'DATA'")


def _build_header(entries: dict[str, list[str]]) -> _Header:
    names = entries.get("FIELDS", [])
    sizes = [_whole_number("SIZE", each) for each in entries.get("SIZE", [])]
    kinds = entries.get("TYPE", [])
    counts = [_whole_number("COUNT", each) for each in entries.get("COUNT", ["1"] * len(names))]
    if not len(names) == len(sizes) == len(kinds) == len(counts):
        raise MalformedRequest("the PCD header's FIELDS, SIZE, TYPE and COUNT differ in length")
    fields = []
    for name, kind, size, count in zip(names, kinds, sizes, counts, strict=True):
        if (kind, size) not in _TYPES:
            raise MalformedRequest(
                f"the PCD field {name!r} has unknown type {kind} of {size} bytes"
            )
        fields.append(_Field(name, _TYPES[kind, size], count))
    match entries["DATA"]:
        case ["ascii" | "binary" | "binary_compressed" as encoding]:
            return _Header(tuple(fields), _count_points(entries), encoding)
        case found:
            raise MalformedRequest(
                f"the PCD file's DATA is {' '.join(found)[:40]!r}, "
                "allowed are ascii, binary and binary_compressed"
            )


def _count_points(entries: dict[str, list[str]]) -> int:
    def entry(key: str) -> int | None:
        match entries.get(key):
            case None:
                return None
            case [value]:
                return _whole_number(key, value)
            case _:
                raise MalformedRequest(f"the PCD header's {key} is not one number")

    points, width, height = entry("POINTS"), entry("WIDTH"), entry("HEIGHT")
    by_size = None if width is None else width * (1 if height is None else height)
    if points is None and by_size is None:
        raise MalformedRequest("the PCD header has neither POINTS nor WIDTH")
    if None not in (points, by_size) and points != by_size:
        raise MalformedRequest(f"the PCD header has POINTS {points}, but WIDTH x HEIGHT {by_size}")
    return points if points is not None else by_size or 0


def _whole_number(key: str, text: str) -> int:
    if not (text.isascii() and text.isdigit() and len(text) <= 18):
        raise MalformedRequest(f"the PCD header's {key} holds {text[:40]!r}, expected a number")
    return int(text)


def _read_ascii(
    stream: io.BytesIO, header: _Header, columns: list[int], max_bytes: int
) -> NDArray[np.float64]:
    offsets = list(itertools.accumulate((each.count for each in header.fields), initial=0))
    lines = itertools.islice(data_lines(stream, "the PCD file"), header.points)
    points = read_columns(
        lines, [offsets[each] for each in columns], "the PCD file", max_bytes=max_bytes
    )
    if len(points) != header.points:
        raise MalformedRequest(
            f"the PCD file claims {header.points} points, but holds {len(points)}"
        )
    return points


def _read_binary(body: bytes, header: _Header, columns: list[int]) -> NDArray[np.float64]:
    claimed = header.points * header.row_size
    if claimed > len(body):
        raise MalformedRequest(
            f"the PCD file claims {header.points} points ({claimed} bytes), "
            f"but holds {len(body)} bytes"
        )
    offsets = list(itertools.accumulate((each.size for each in header.fields), initial=0))
    row = np.dtype(
        {
            "names": ["x", "y", "z"],
            "formats": [header.fields[each].type for each in columns],
            "offsets": [offsets[each] for each in columns],
            "itemsize": header.row_size,
        }
    )
    rows = np.frombuffer(body, dtype=row, count=header.points)
    return _as_points([rows[axis] for axis in "xyz"])


def _read_compressed(body: bytes, header: _Header, columns: list[int]) -> NDArray[np.float64]:
    """Unpack the LZF block and read it; there each field's values lie together."""
    if len(body) < 8:
        raise MalformedRequest("the PCD file ends before its compressed data")
    packed_size, unpacked_size = struct.unpack_from("<II", body)
    claimed = header.points * header.row_size
    if unpacked_size != claimed or packed_size > len(body) - 8:
        raise MalformedRequest(
            f"the PCD file claims {header.points} points ({claimed} bytes), but its compressed "
            f"data are {packed_size} bytes ({len(body) - 8} present) that give {unpacked_size}"
        )
    try:
        unpacked = lzf.decompress(body[8 : 8 + packed_size], unpacked_size)
    except ValueError as error:
        raise MalformedRequest(f"the PCD file's compressed data are damaged: {error}") from None
    if unpacked is None or len(unpacked) != unpacked_size:
        raise MalformedRequest("the PCD file's compressed data are damaged")
    starts = list(
        itertools.accumulate((each.size * header.points for each in header.fields), initial=0)
    )
    axes = [
        np.frombuffer(
            unpacked, dtype=header.fields[each].type, count=header.points, offset=starts[each]
        )
        for each in columns
    ]
    return _as_points(axes)


def _as_points(axes: Sequence[NDArray[Any]]) -> NDArray[np.float64]:
    with np.errstate(invalid="ignore"):  # a signalling NaN is a NaN
        return np.column_stack([each.astype(np.float64) for each in axes])
