"""Points of a PLY file: the x, y, z of its vertices, from bytes that nobody vouches for.

Written here rather than taken from a library because the known readers
allocate what the header claims before they look at the bytes.

Source: G. Turk, "The PLY Polygon File Format", 1994.
"""

from __future__ import annotations

import io
import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shared.errors import InvalidInput, MalformedRequest, PayloadTooLarge
from shared.wire.text_table import read_columns, read_line

MAX_HEADER_LINES = 1000
_BYTE_ORDER = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_TYPES = {
    "char": "i1",
    "int8": "i1",
    "uchar": "u1",
    "uint8": "u1",
    "short": "i2",
    "int16": "i2",
    "ushort": "u2",
    "uint16": "u2",
    "int": "i4",
    "int32": "i4",
    "uint": "u4",
    "uint32": "u4",
    "float": "f4",
    "float32": "f4",
    "double": "f8",
    "float64": "f8",
}


@dataclass(frozen=True)
class _Property:
    name: str
    type: str
    is_list: bool

    @property
    def size(self) -> int:
        return np.dtype(self.type).itemsize


@dataclass(frozen=True)
class _Element:
    name: str
    count: int
    properties: tuple[_Property, ...] = ()

    @property
    def has_list(self) -> bool:
        return any(each.is_list for each in self.properties)

    @property
    def row_size(self) -> int:
        return sum(each.size for each in self.properties)


def read_ply(data: bytes, max_unpacked_bytes: int) -> NDArray[np.float64]:
    """Return the vertices (N, 3) of a PLY file, in the file's own unit.

    Other elements and properties are passed over; faces are never read.

    Raises
    ------
    MalformedRequest
        Not a PLY file, truncated, or its header claims more than it holds.
    InvalidInput
        It has no vertices with x, y, z, or a layout that is not read here.
    PayloadTooLarge
        The points would need more than `max_unpacked_bytes`.
    """
    stream = io.BytesIO(data)
    order, elements = _read_header(stream)
    before = list(itertools.takewhile(lambda each: each.name != "vertex", elements))
    if len(before) == len(elements):
        names = [each.name for each in elements]
        raise InvalidInput("the PLY file has no element 'vertex'", field="file", found=names)
    vertex = elements[len(before)]
    if vertex.count * 24 > max_unpacked_bytes:
        raise PayloadTooLarge(
            f"the PLY file claims {vertex.count} points, allowed are {max_unpacked_bytes // 24}",
            found=vertex.count,
            allowed=max_unpacked_bytes // 24,
        )
    if order == "":
        return _read_ascii(stream, before, vertex, max_unpacked_bytes)
    return _read_binary(data, stream.tell(), order, before, vertex)


def _read_header(stream: io.BytesIO) -> tuple[str, list[_Element]]:
    """Return the byte order ("" for ASCII) and the elements; leaves the stream at the body."""
    if read_line(stream, "the PLY file").strip() != "ply":
        raise MalformedRequest("the file does not start with 'ply': it is not a PLY file")
    order: str | None = None
    elements: list[_Element] = []
    for _ in range(MAX_HEADER_LINES):
        line = read_line(stream, "the PLY file")
        match line.split():
            case ["end_header"] if line.endswith("\n"):
                if order is None:
                    raise MalformedRequest("the PLY header has no line 'format'")
                return order, elements
            case ["format", kind, "1.0"] if kind in _BYTE_ORDER and order is None:
                order = _BYTE_ORDER[kind]
            case ["element", name, count] if count.isascii() and count.isdigit():
                if len(count) > 18 or any(each.name == name for each in elements):
                    raise MalformedRequest(f"the PLY header's line {line[:80].strip()!r} is wrong")
                elements.append(_Element(name, int(count)))
            case ["property", "list", length, kind, name] if {length, kind} <= _TYPES.keys():
                _add_property(elements, _Property(name, _TYPES[kind], is_list=True))
            case ["property", kind, name] if kind in _TYPES:
                _add_property(elements, _Property(name, _TYPES[kind], is_list=False))
            case ["comment" | "obj_info", *_]:
                pass
            case _:
                shown = line[:80].strip()
                raise MalformedRequest(
                    f"the PLY header has a line that is not understood: {shown!r}"
                )
    raise MalformedRequest(f"the PLY header has no 'end_header' within {MAX_HEADER_LINES} lines")


def _add_property(elements: list[_Element], added: _Property) -> None:
    if not elements:
        raise MalformedRequest("the PLY header has a property before its first element")
    last = elements[-1]
    if any(each.name == added.name for each in last.properties):
        raise MalformedRequest(f"the PLY header has property {added.name!r} twice")
    elements[-1] = _Element(last.name, last.count, (*last.properties, added))


def _xyz(vertex: _Element) -> list[int]:
    """Return which of the vertex's properties are x, y and z."""
    names = [each.name for each in vertex.properties]
    missing = [axis for axis in "xyz" if axis not in names]
    if missing:
        raise InvalidInput(
            f"the PLY file's vertices lack {', '.join(missing)}; they have {names[:20]}",
            field="file",
            found=names[:20],
            allowed=["x", "y", "z"],
        )
    indices = [names.index(axis) for axis in "xyz"]
    if any(each.is_list for each in vertex.properties[: max(indices) + 1]):
        raise InvalidInput("lists among or before x, y, z of a PLY vertex are not read here")
    return indices


def _read_ascii(
    stream: io.BytesIO, before: list[_Element], vertex: _Element, max_bytes: int
) -> NDArray[np.float64]:
    columns = _xyz(vertex)
    left = len(stream.getbuffer()) - stream.tell()
    rows_before = sum(each.count for each in before)
    if rows_before + 5 * vertex.count > left:  # a line is at least "0 0 0", the last without end
        raise MalformedRequest(
            f"the PLY file claims {vertex.count} vertices, but holds {left} bytes"
        )
    lines = iter(lambda: read_line(stream, "the PLY file"), "")
    rows = itertools.islice(lines, rows_before, rows_before + vertex.count)
    body = (line for line in rows if line.strip())
    points = read_columns(body, columns, "the PLY file", max_bytes=max_bytes)
    if len(points) != vertex.count:
        raise MalformedRequest(
            f"the PLY file claims {vertex.count} vertices, but holds {len(points)}"
        )
    return points


def _read_binary(
    data: bytes, start: int, order: str, before: list[_Element], vertex: _Element
) -> NDArray[np.float64]:
    columns = _xyz(vertex)
    if vertex.has_list or any(each.has_list for each in before):
        raise InvalidInput(
            "a binary PLY file with lists in or before its vertices is not read here; "
            "put the vertices first"
        )
    start += sum(each.count * each.row_size for each in before)
    claimed, held = vertex.count * vertex.row_size, max(len(data) - start, 0)
    if claimed > held:
        raise MalformedRequest(
            f"the PLY file claims {vertex.count} vertices ({claimed} bytes), but holds {held} bytes"
        )
    offsets = list(itertools.accumulate((each.size for each in vertex.properties), initial=0))
    rows = np.frombuffer(
        data,
        dtype=np.dtype(
            {
                "names": ["x", "y", "z"],
                "formats": [order + vertex.properties[each].type for each in columns],
                "offsets": [offsets[each] for each in columns],
                "itemsize": vertex.row_size,
            }
        ),
        count=vertex.count,
        offset=min(start, len(data)),
    )
    with np.errstate(invalid="ignore"):  # a signalling NaN is a NaN
        return np.column_stack([rows[axis].astype(np.float64) for axis in "xyz"])
