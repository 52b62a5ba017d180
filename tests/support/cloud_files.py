"""Files with points and depth, written by hand so that each part can be a lie."""

from __future__ import annotations

import io

import numpy as np
from numpy.typing import NDArray
from PIL import Image


def ply(body: bytes, *header: str, encoding: str = "binary_little_endian") -> bytes:
    lines = ["ply", f"format {encoding} 1.0", *header, "end_header", ""]
    return "\n".join(lines).encode() + body


def xyz_header(count: int, kind: str = "float") -> list[str]:
    return [f"element vertex {count}", *(f"property {kind} {axis}" for axis in "xyz")]


def pcd(body: bytes, encoding: str, points: int, **changes: str) -> bytes:
    entries = {
        "VERSION": "0.7",
        "FIELDS": "x y z",
        "SIZE": "4 4 4",
        "TYPE": "F F F",
        "COUNT": "1 1 1",
        "WIDTH": str(points),
        "HEIGHT": "1",
        "VIEWPOINT": "0 0 0 1 0 0 0",
        "POINTS": str(points),
        "DATA": encoding,
    } | changes
    text = "".join(f"{key} {value}\n" for key, value in entries.items() if value)
    return b"# .PCD v0.7\n" + text.encode() + body


def png(image: NDArray[np.generic]) -> bytes:
    stream = io.BytesIO()
    Image.fromarray(image).save(stream, "PNG")
    return stream.getvalue()
