"""PointCloud2 messages as JSON, as different drivers write them."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np

FLOAT32, FLOAT64 = 7, 8


def cloud_message(
    points: np.ndarray,
    *,
    height: int = 1,
    big_endian: bool = False,
    double: bool = False,
    padding: int = 0,
    as_list: bool = False,
) -> dict[str, Any]:
    """Return points (N, 3) as a message of `height` rows, each followed by `padding` bytes.

    As an RGB-D driver has it: x, y, z, four bytes of nothing, rgb.
    """
    number = ("f8" if double else "f4", FLOAT64 if double else FLOAT32)
    size = 8 if double else 4
    order = ">" if big_endian else "<"
    point = np.dtype(
        {
            "names": ["x", "y", "z", "rgb"],
            "formats": [order + number[0]] * 3 + [order + "f4"],
            "offsets": [0, size, 2 * size, 3 * size + 4],
            "itemsize": 3 * size + 8,
        }
    )
    rows = np.zeros(len(points), point)
    for axis, values in zip("xyz", points.T, strict=True):
        rows[axis] = values
    width = len(points) // height
    data = b"".join(
        rows[row * width : (row + 1) * width].tobytes() + b"\xff" * padding for row in range(height)
    )
    fields = [
        {"name": name, "offset": point.fields[name][1], "datatype": kind, "count": 1}
        for name, kind in (("x", number[1]), ("y", number[1]), ("z", number[1]), ("rgb", FLOAT32))
        if point.fields is not None
    ]
    return {
        "header": {"stamp": {"sec": 1700000000, "nanosec": 5}, "frame_id": "camera_optical"},
        "height": height,
        "width": width,
        "fields": fields,
        "is_bigendian": big_endian,
        "point_step": point.itemsize,
        "row_step": width * point.itemsize + padding,
        "data": list(data) if as_list else base64.b64encode(data).decode(),
        "is_dense": bool(np.isfinite(points).all()),
    }
