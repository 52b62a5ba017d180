"""Files that lie, explode or go in circles, made here so that one can see what is wrong with them.

Each comes with the HTTP status that is right for it where `ALLOWED` bytes may be unpacked.
"""

from __future__ import annotations

import io
import struct
import zipfile
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import lzf
import numpy as np

from tests.support.cloud_files import pcd, ply, xyz_header

ALLOWED = 4 * 2**20
MALFORMED, TOO_LARGE, INVALID = 400, 413, 422
QUINTILLION = 10**18 - 1
ZEROS = bytes(2**24)


@dataclass(frozen=True)
class Hostile:
    """One file: its name, how it is made, and the status that it deserves."""

    name: str
    extension: str
    make: Callable[[], bytes]
    status: int


def hostile_files() -> Iterator[Hostile]:
    """Yield the corpus; nothing is made yet."""
    yield from (Hostile(name, ".ply", make, status) for name, make, status in _plys())
    yield from (Hostile(name, ".pcd", make, status) for name, make, status in _pcds())
    yield from (Hostile(name, ".npz", make, status) for name, make, status in _npzs())
    yield from (Hostile(name, ".png", make, status) for name, make, status in _pngs())
    yield from (Hostile(name, ".xyz", make, status) for name, make, status in _xyzs())


Entry = tuple[str, Callable[[], bytes], int]


def _plys() -> Iterator[Entry]:
    most = [f"property double p{number}" for number in range(900)]
    yield "a header and nothing else", lambda: ply(b"", *xyz_header(1)), MALFORMED
    yield "no end of the header", lambda: b"ply\nformat ascii 1.0\n" * 1, MALFORMED
    yield "a quintillion vertices", lambda: ply(b"", *xyz_header(QUINTILLION)), TOO_LARGE
    yield "more vertices than bytes", lambda: ply(b"", *xyz_header(150_000)), MALFORMED
    yield (
        "more vertices than lines",
        lambda: ply(b"\n" * 10**6, *xyz_header(150_000), encoding="ascii"),
        MALFORMED,
    )
    yield (
        "a quintillion wide rows before the vertices",
        lambda: ply(b"", f"element pad {QUINTILLION}", *most, *xyz_header(1)),
        MALFORMED,
    )
    yield (
        "wide rows",
        lambda: ply(b"\0" * 99, *xyz_header(150_000), *most),
        MALFORMED,
    )
    yield (
        "a list of four billion",
        lambda: ply(
            b"\xff" * 64, "element vertex 1", "property list uint double x", *xyz_header(1)[1:]
        ),
        MALFORMED,
    )
    yield (
        "lists before the vertices",
        lambda: ply(b"\xff" * 64, "element face 9", "property list uint int i", *xyz_header(1)),
        INVALID,
    )
    yield "a count below nothing", lambda: ply(b"", "element vertex -1"), MALFORMED
    yield "a count with a plus", lambda: ply(b"", "element vertex +1"), MALFORMED
    yield "digits of another script", lambda: ply(b"", "element vertex \u0663"), MALFORMED
    yield "a thousand elements", lambda: ply(b"", *_elements(990), *xyz_header(1)), MALFORMED
    yield "a line of a megabyte", lambda: b"ply\ncomment " + b"a" * 2**20, MALFORMED
    yield (
        "a million comments",
        lambda: b"ply\n" + b"comment\n" * 10**6,
        MALFORMED,
    )
    yield "text in place of numbers", lambda: _ascii_ply(b"a b c\n"), MALFORMED
    yield "all points not a number", lambda: _ascii_ply(b"nan inf -inf\n" * 50, 50), INVALID
    yield (
        "binary points not a number",
        lambda: ply(b"\xff" * 1200, *xyz_header(100)),
        INVALID,
    )


def _elements(count: int) -> list[str]:
    return [f"element e{number} {QUINTILLION}" for number in range(count)]


def _ascii_ply(body: bytes, count: int = 1) -> bytes:
    return ply(body, *xyz_header(count), encoding="ascii")


def _pcds() -> Iterator[Entry]:
    yield "a header and nothing else", lambda: pcd(b"", "binary", 1), MALFORMED
    yield "a quintillion points", lambda: pcd(b"", "binary", QUINTILLION), TOO_LARGE
    yield (
        "width times height beyond 64 bits",
        lambda: pcd(b"", "ascii", 1, POINTS="", WIDTH=str(QUINTILLION), HEIGHT=str(QUINTILLION)),
        TOO_LARGE,
    )
    yield (
        "no points of a quintillion bytes",
        lambda: pcd(b"", "binary", 0, COUNT=f"1 1 1 {QUINTILLION}", **_FOURTH),
        INVALID,
    )
    yield (
        "one point of a quintillion bytes",
        lambda: pcd(b"\0" * 99, "binary", 1, COUNT=f"1 1 1 {QUINTILLION}", **_FOURTH),
        TOO_LARGE,
    )
    yield (
        "no compressed points of a quintillion bytes",
        lambda: pcd(b"", "binary_compressed", 0, COUNT=f"1 1 1 {QUINTILLION}", **_FOURTH),
        INVALID,
    )
    yield "points of no size", lambda: pcd(b"", "binary", 9, COUNT="0 0 0"), INVALID
    yield "ten thousand fields", lambda: _wide_pcd(10_000), TOO_LARGE
    yield "compressed to less than it claims", lambda: _lzf_pcd(b"\0" * 12, 40_000), MALFORMED
    yield "compressed to more than it claims", lambda: _lzf_pcd(ZEROS, 1), MALFORMED
    yield (
        "references before the beginning",
        lambda: pcd(
            struct.pack("<II", 6, 12) + b"\xff\xff\xff\xff\xff\xff", "binary_compressed", 1
        ),
        MALFORMED,
    )
    yield (
        "a compressed size beyond the file",
        lambda: pcd(struct.pack("<II", 2**32 - 1, 12), "binary_compressed", 1),
        MALFORMED,
    )
    yield "four gigabytes unpacked", lambda: _lzf_pcd(b"\0", 2**28), TOO_LARGE
    yield "comments without end", lambda: b"# .PCD\n" * 10**6, MALFORMED
    yield "an encoding of its own", lambda: pcd(b"", "pickle", 1), MALFORMED
    yield "all points not a number", lambda: pcd(b"\xff" * 1200, "binary", 100), INVALID


_FOURTH = {"FIELDS": "x y z w", "SIZE": "4 4 4 8", "TYPE": "F F F F"}


def _wide_pcd(fields: int) -> bytes:
    return pcd(
        b"\0" * 99,
        "binary",
        1000,
        FIELDS="x y z" + " _" * fields,
        SIZE="4 4 4" + " 8" * fields,
        TYPE="F F F" + " F" * fields,
        COUNT="1 1 1" + " 1" * fields,
    )


def _lzf_pcd(content: bytes, points: int) -> bytes:
    packed = lzf.compress(content) or content
    sizes = struct.pack("<II", len(packed), 12 * points % 2**32)
    return pcd(sizes + packed, "binary_compressed", points)


def _npzs() -> Iterator[Entry]:
    yield "16 MB of zeros", lambda: zipped({"points.npy": ZEROS}), TOO_LARGE
    yield "128 MB of zeros that claim to be 100 bytes", _lying_zip, MALFORMED
    yield "archives in an archive", lambda: _nested_zip(20), INVALID
    yield "members that overlap", _overlapping_zip, TOO_LARGE
    yield "a thousand members", lambda: zipped(dict.fromkeys(map(str, range(1000)), b"")), TOO_LARGE
    yield "half of it", lambda: zipped({"points.npy": npy("'<f8'", "(2, 3)", 48)})[:90], MALFORMED
    yield "pickled objects", lambda: npz_of("'|O'", "(1,)", 8), MALFORMED
    yield "a quintillion points", lambda: npz_of("'<f8'", f"({QUINTILLION}, 3)", 48), MALFORMED
    yield "a quintillion texts of no size", lambda: npz_of("'|S0'", f"({QUINTILLION},)", 0), 400
    yield "a length that wraps around", lambda: npz_of("'<f8'", f"({2**61}, 8)", 0), MALFORMED
    yield "nothing, a quintillion wide", lambda: npz_of("'<f8'", f"(0, {QUINTILLION}, 9)", 0), 400
    yield "a hundred dimensions", lambda: npz_of("'<f8'", f"({'1, ' * 100})", 8), MALFORMED
    yield "a negative length", lambda: npz_of("'<f8'", "(-1, 3)", 24), MALFORMED
    yield "a shape of truth values", lambda: npz_of("'<f8'", "(True, 3)", 24), MALFORMED
    yield "a header of brackets", lambda: npz_of("'<f8'", "(" * 9000 + ")" * 9000, 0), MALFORMED
    yield "a header that computes", lambda: npz_of("'<f8'", "(9**9**9, 3)", 0), MALFORMED
    yield "a header of four gigabytes", _npy_with_long_header, MALFORMED
    yield "nested types", lambda: npz_of("[('a', " * 500 + "'<f8'" + ")]" * 500, "(1,)", 8), 400
    yield "dates", lambda: npz_of("'<M8[ns]'", "(1, 3)", 24), INVALID
    yield "neither points nor depth", lambda: zipped({"x.npy": npy("'<f8'", "(3,)", 24)}), INVALID
    yield "a name with a path", lambda: zipped({"../../points.npy": npy("'<f8'", "(3,)", 24)}), 422
    yield "all points not a number", lambda: zipped({"points.npy": _nan_points()}), INVALID


def zipped(members: dict[str, bytes]) -> bytes:
    """Return a compressed archive of these members."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return stream.getvalue()


def npy(descr: str, shape: str, body: int) -> bytes:
    """Return an npy file with this header, true or not, and so many bytes of zeros."""
    text = f"{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}\n".encode()
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text + bytes(body)


def npz_of(descr: str, shape: str, body: int) -> bytes:
    """Return an archive whose points are such an npy file."""
    return zipped({"points.npy": npy(descr, shape, body)})


def _nan_points() -> bytes:
    stream = io.BytesIO()
    np.save(stream, np.full((50, 3), np.nan))
    return stream.getvalue()


def _lying_zip() -> bytes:
    honest = zipped({"points.npy": ZEROS * 8})
    return honest.replace(struct.pack("<I", 8 * len(ZEROS)), struct.pack("<I", 100))


def _nested_zip(depth: int) -> bytes:
    content = ZEROS[: 2**20]
    for _ in range(depth):
        content = zipped({"a.npz": content})
    return zipped({"x.npy": npy("'|u1'", f"({len(content)},)", 0) + content})


def _overlapping_zip() -> bytes:
    """Return an archive whose directory names the same megabyte in all of its 64 entries."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("points.npy", ZEROS[: 2**20])
        archive.filelist.extend([archive.filelist[0]] * 63)
    return stream.getvalue()


def _npy_with_long_header() -> bytes:
    return zipped({"points.npy": b"\x93NUMPY\x02\x00" + struct.pack("<I", 2**32 - 1) + b"{" * 99})


def _pngs() -> Iterator[Entry]:
    image = zlib.compress(bytes(9 * 4))
    yield "a signature and nothing else", lambda: png_of(), MALFORMED
    yield "half of it", lambda: png_of(header(4, 4), ("IDAT", image))[:-20], MALFORMED
    yield "no pixels", lambda: png_of(header(4, 4), ("IEND", b"")), MALFORMED
    yield "too few pixels", lambda: _png(zlib.compress(b"\0" * 9)), INVALID
    yield "a size of four billion by four billion", lambda: _png(image, 2**32 - 1), TOO_LARGE
    yield "a size of nothing", lambda: _png(image, 0), MALFORMED
    yield "16 MB of pixels where 16 are due", lambda: _png(zlib.compress(ZEROS)), INVALID
    yield "pixels that are no zlib", lambda: _png(b"\xff" * 99), MALFORMED
    yield "a wrong sum", lambda: _png(image)[:-14] + b"\0" * 14, INVALID
    yield "16 MB of text", lambda: _with_chunk("zTXt", b"a\0\0" + zlib.compress(ZEROS)), MALFORMED
    yield (
        "16 MB of profile",
        lambda: _with_chunk("iCCP", b"a\0\0" + zlib.compress(ZEROS)),
        MALFORMED,
    )
    yield "ten thousand chunks", lambda: _with_chunk("tEXt", b"a\0b", 10_000), INVALID
    yield "a chunk of four gigabytes", lambda: _png(image)[:33] + b"\xff" * 4 + b"IDAT", MALFORMED
    yield "frames", lambda: _with_chunk("acTL", struct.pack(">II", 2**31 - 1, 0)), INVALID
    yield "eight bits", lambda: png_of(header(4, 4, bits=8), ("IDAT", image)), INVALID
    yield "a palette", lambda: png_of(header(4, 4, bits=8, colour=3), ("IDAT", image)), INVALID
    yield "another format inside", lambda: b"\x89PNG\r\n\x1a\n" + b"II*\0" * 20, MALFORMED


Chunk = tuple[str, bytes]


def png_of(*chunks: Chunk) -> bytes:
    """Return a PNG file of these chunks, each with its sum."""
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(body))
        + kind.encode()
        + body
        + struct.pack(">I", zlib.crc32(kind.encode() + body))
        for kind, body in chunks
    )


def header(width: int, height: int, *, bits: int = 16, colour: int = 0) -> Chunk:
    """Return the first chunk of a PNG file."""
    return "IHDR", struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, 0)


def _png(pixels: bytes, size: int = 4) -> bytes:
    return png_of(header(size, size), ("IDAT", pixels), ("IEND", b""))


def _with_chunk(kind: str, body: bytes, times: int = 1) -> bytes:
    pixels = zlib.compress(bytes(9 * 4))
    more = [(kind, body)] * times
    return png_of(header(4, 4), *more, ("IDAT", pixels), ("IEND", b""))


def _xyzs() -> Iterator[Entry]:
    yield "nothing", lambda: b"", INVALID
    yield "zeros", lambda: bytes(2**20), MALFORMED
    yield "a line of a megabyte", lambda: b"1 " * 2**19, MALFORMED
    yield "a million blank lines", lambda: b"\n" * 10**6, MALFORMED
    yield "more points than allowed", lambda: b"0 0 0\n" * 200_000, TOO_LARGE
    yield "more columns on every line", lambda: _stairs(200), MALFORMED
    yield "two columns", lambda: b"1 2\n" * 99, MALFORMED
    yield "another encoding", lambda: "1 2 3\n".encode("utf-16") * 99, MALFORMED
    yield "digits of another script", lambda: "\u0661 \u0662 \u0663\n".encode() * 99, MALFORMED
    yield "numbers of a thousand digits", lambda: (b"9" * 1000 + b" 1 2\n") * 99, INVALID
    yield "all points not a number", lambda: b"nan inf -inf\n" * 99, INVALID


def _stairs(steps: int) -> bytes:
    return b"".join(b"1 " * number + b"\n" for number in range(1, steps))
