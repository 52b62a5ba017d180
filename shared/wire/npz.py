"""Reading and writing npz archives without trusting them.

`numpy.load` would unpack whatever the archive claims to hold. Here the size
of every member is known and bounded before a byte of it is unpacked, the
header of every array is checked against the bytes that are really there, and
object arrays (pickles) are refused.
"""

from __future__ import annotations

import io
import math
import re
import zipfile
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shared.errors import MalformedRequest, PayloadTooLarge

MAX_MEMBERS = 64


def read_npz(data: bytes, max_unpacked_bytes: int) -> dict[str, NDArray[Any]]:
    """Return the arrays of an npz archive by name.

    Parameters
    ----------
    data : bytes
        The archive.
    max_unpacked_bytes : int
        Bound on the sum of the unpacked sizes.

    Raises
    ------
    MalformedRequest
        Not a zip archive, truncated, or a member is not a plain numeric array.
    PayloadTooLarge
        It would unpack to more than allowed.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = archive.infolist()
            _check_sizes(members, max_unpacked_bytes)
            contents = {member.filename: _unpack(archive, member) for member in members}
    except (zipfile.BadZipFile, zlib.error, EOFError, OSError, ValueError, OverflowError) as error:
        raise MalformedRequest(f"the body is not a complete npz archive: {error}") from None
    except RuntimeError as error:  # zipfile's word for an encrypted or exotic member
        raise MalformedRequest(f"the npz archive cannot be read: {error}") from None
    return {name.removesuffix(".npy"): read_npy(held, name) for name, held in contents.items()}


def _check_sizes(members: list[zipfile.ZipInfo], max_unpacked_bytes: int) -> None:
    if len(members) > MAX_MEMBERS:
        raise PayloadTooLarge(
            f"the npz archive holds {len(members)} arrays, allowed are {MAX_MEMBERS}",
            found=len(members),
            allowed=MAX_MEMBERS,
        )
    for member in members:
        if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise MalformedRequest(
                f"array {member.filename!r} is compressed by a method that npz does not use"
            )
    unpacked = sum(member.file_size for member in members)
    if unpacked > max_unpacked_bytes:
        raise PayloadTooLarge(
            f"the npz archive unpacks to {unpacked} bytes, allowed are {max_unpacked_bytes}",
            found=unpacked,
            allowed=max_unpacked_bytes,
        )


def _unpack(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> bytes:
    """Return the content of a member; no more is unpacked than it claims to hold.

    `ZipFile.read` would unpack up to 1 GiB before it looks at the claim.
    """
    with archive.open(member) as stream:
        return stream.read(member.file_size)


def read_npy(content: bytes, name: str) -> NDArray[Any]:
    """Return the one array of an npy file; `name` is for messages.

    Raises
    ------
    MalformedRequest
        Not a plain numeric array, or not as large as it claims.
    """
    try:
        shape, fortran_order, dtype, start = _usual_header(content) or _any_header(content)
    except (ValueError, SyntaxError, RecursionError, MemoryError, TypeError) as error:
        raise MalformedRequest(f"array {name!r} has no valid npy header: {error}") from None
    if dtype.itemsize == 0:
        raise MalformedRequest(f"array {name!r} holds values of no size")
    if dtype.hasobject:
        raise MalformedRequest(
            f"array {name!r} holds pickled objects; only plain numbers are accepted"
        )
    count = math.prod(shape)
    if min(shape, default=1) < 0 or count * dtype.itemsize != len(content) - start:
        raise MalformedRequest(
            f"array {name!r} claims shape {shape} of {dtype}, "
            f"but holds {len(content) - start} bytes"
        )
    try:
        if count == 0:
            return np.zeros(shape, dtype)
        flat = np.frombuffer(content, dtype=dtype, offset=start)
        return flat.reshape(shape, order="F" if fortran_order else "C")
    except (ValueError, TypeError) as error:  # more dimensions than NumPy has, lengths beyond it
        raise MalformedRequest(f"array {name!r} cannot be held: {error}") from None


Header = tuple[tuple[int, ...], bool, np.dtype[Any], int]
"""Shape, Fortran order, type of the values, and where they start."""

_USUAL = re.compile(
    rb"\x93NUMPY\x01\x00(?P<length>..)\{'descr': '(?P<descr>[<|][biuf]\d)', "
    rb"'fortran_order': (?P<fortran>True|False), "
    rb"'shape': \((?P<shape>(?:\d{1,18}, ?)*(?:\d{1,18})?)\), \} *\n",
    re.DOTALL,
)


def _usual_header(content: bytes) -> Header | None:
    """Read a header as NumPy and we write it for plain numbers; None when it is another one.

    NumPy's own reader lets Python's parser read every header, 45 us instead of 3.
    """
    found = _USUAL.match(content)
    if found is None or found.end() != 10 + int.from_bytes(found["length"], "little"):
        return None
    shape = tuple(int(each) for each in found["shape"].split(b",") if each.strip())
    return shape, found["fortran"] == b"True", np.dtype(found["descr"].decode()), found.end()


def _any_header(content: bytes) -> Header:
    stream = io.BytesIO(content)
    version = np.lib.format.read_magic(stream)
    read_header = (
        np.lib.format.read_array_header_1_0
        if version == (1, 0)
        else np.lib.format.read_array_header_2_0
    )
    shape, fortran_order, dtype = read_header(stream)
    return shape, fortran_order, dtype, stream.tell()


def write_npz(arrays: Mapping[str, ArrayLike], *, compress: bool = False) -> bytes:
    """Return an npz archive of `arrays`; same arrays, same bytes."""
    stream = io.BytesIO()
    method = zipfile.ZIP_DEFLATED if compress else zipfile.ZIP_STORED
    with zipfile.ZipFile(stream, "w", method) as archive:
        for name, array in arrays.items():
            member = zipfile.ZipInfo(f"{name}.npy")  # a fixed date: no clock in the bytes
            member.compress_type = method
            archive.writestr(member, write_npy(array))
    return stream.getvalue()


def write_npy(array: ArrayLike) -> memoryview:
    """Return an npy file of an array."""
    stream = io.BytesIO()
    np.lib.format.write_array(stream, np.asarray(array), allow_pickle=False)
    return stream.getbuffer()
