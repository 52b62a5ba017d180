"""sensor_msgs/PointCloud2 as JSON, from anybody: what it claims is held against its bytes.

Source: the .msg files of sensor_msgs (ROS 1 and 2). `data` is base64, as rosbridge writes it, or a
list of bytes.
"""

from __future__ import annotations

import binascii
from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import AliasChoices, BeforeValidator, Field
from pydantic_core import PydanticCustomError

from shared.errors import InvalidInput, PayloadTooLarge
from shared.schemas.ros import FrameId, RosTime
from shared.wire import Message

UInt32 = Annotated[int, Field(ge=0, lt=2**32)]
MARKS = ("point_step", "row_step", "is_bigendian")
"""A JSON object with one of these fields is meant as a PointCloud2."""
_TYPES = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
_TYPES |= {9: "i8", 10: "u8", 11: "b1"}  # in ROS 2 Rolling
_COORDINATES = {7: "FLOAT32", 8: "FLOAT64"}


class PointField(Message):
    """sensor_msgs/PointField."""

    name: Annotated[str, Field(max_length=128)]
    offset: UInt32
    datatype: UInt32
    count: UInt32 = 1


class CloudTime(RosTime):
    """builtin_interfaces/Time, or time as ROS 1 has it: secs and nsecs."""

    sec: Annotated[
        int, Field(ge=-(2**31), lt=2**31, validation_alias=AliasChoices("sec", "secs"))
    ] = 0
    nanosec: Annotated[
        int, Field(ge=0, lt=10**9, validation_alias=AliasChoices("nanosec", "nsecs"))
    ] = 0


class CloudHeader(Message):
    """std_msgs/Header of ROS 1 or 2."""

    seq: UInt32 | None = None
    stamp: CloudTime = CloudTime()
    frame_id: FrameId = ""


def _bytes(data: object) -> object:
    if isinstance(data, str):
        try:
            return binascii.a2b_base64(data, strict_mode=True)
        except (binascii.Error, ValueError):
            raise PydanticCustomError("base64", "is a text, but not base64") from None
    if isinstance(data, list):
        try:
            return bytes(data)
        except (ValueError, TypeError):
            raise PydanticCustomError("octets", "must be a list of integers in 0..255") from None
    return data


class PointCloud2(Message):
    """sensor_msgs/PointCloud2."""

    header: CloudHeader = CloudHeader()
    height: UInt32
    width: UInt32
    fields: Annotated[tuple[PointField, ...], Field(max_length=256)]
    is_bigendian: bool = False
    point_step: UInt32
    row_step: UInt32
    data: Annotated[
        bytes,
        BeforeValidator(_bytes, json_schema_input_type=str | list[int]),
    ]
    is_dense: bool = False
    """Whether all points are valid. Not relied on: what is not finite is no return."""


def is_point_cloud2(fields: Mapping[str, Any]) -> bool:
    """Tell whether a JSON object is shaped like a PointCloud2, whole or in part."""
    return any(mark in fields for mark in MARKS)


def cloud_points(cloud: PointCloud2, max_bytes: int) -> NDArray[np.float64]:
    """Return the points (height*width, 3) of a cloud, row-major, in its own unit.

    Raises
    ------
    InvalidInput
        It has no x, y, z, or its sizes contradict each other or the bytes that are there.
    PayloadTooLarge
        The points would take more than `max_bytes`.
    """
    for field in cloud.fields:
        _require_inside(field, cloud.point_step)
    offsets = {axis: _coordinate(cloud, axis) for axis in "xyz"}
    _require_whole(cloud)
    count = cloud.height * cloud.width
    if count == 0:
        return np.empty((0, 3))
    if 24 * count > max_bytes:
        raise PayloadTooLarge(
            f"the PointCloud2 holds {count} points, which take {24 * count} bytes; allowed are "
            f"{max_bytes}",
            found=24 * count,
            allowed=max_bytes,
        )
    order = ">" if cloud.is_bigendian else "<"
    point = np.dtype(
        {
            "names": list(offsets),
            "formats": [order + _TYPES[field.datatype] for field in offsets.values()],
            "offsets": [field.offset for field in offsets.values()],
            "itemsize": cloud.point_step,
        }
    )
    rows: NDArray[Any] = np.ndarray(
        (cloud.height, cloud.width),
        point,
        buffer=cloud.data,
        strides=(cloud.row_step, cloud.point_step),
    )
    with np.errstate(invalid="ignore"):  # a signalling NaN is a NaN
        return np.column_stack([rows[axis].ravel().astype(np.float64) for axis in offsets])


def _require_inside(field: PointField, point_step: int) -> None:
    if field.datatype not in _TYPES:
        raise _wrong(
            f"field {field.name[:40]!r} has datatype {field.datatype}; known are 1 to 11 (FLOAT32 "
            "is 7, FLOAT64 is 8)",
            found=field.datatype,
            allowed=list(_TYPES),
        )
    end = field.offset + max(field.count, 1) * np.dtype(_TYPES[field.datatype]).itemsize
    if end > point_step:
        raise _wrong(
            f"field {field.name[:40]!r} ends at byte {end} of a point; point_step is {point_step}",
            found=end,
            allowed=point_step,
        )


def _coordinate(cloud: PointCloud2, axis: str) -> PointField:
    found = [field for field in cloud.fields if field.name == axis]
    if len(found) != 1:
        names = [field.name[:40] for field in cloud.fields][:20]
        raise _wrong(f"the fields x, y, z are needed once each; it has {names}", found=names)
    (field,) = found
    if field.datatype not in _COORDINATES or field.count > 1:  # some drivers write a count of 0
        raise _wrong(
            f"field {axis!r} must be one FLOAT32 (7) or FLOAT64 (8); found {field.count} of "
            f"datatype {field.datatype}",
            found=field.datatype,
            allowed=list(_COORDINATES),
        )
    return field


def _require_whole(cloud: PointCloud2) -> None:
    row = cloud.width * cloud.point_step
    if cloud.row_step < row:
        raise _wrong(
            f"row_step is {cloud.row_step}, but a row of {cloud.width} points of "
            f"{cloud.point_step} bytes takes {row}",
            found=cloud.row_step,
            allowed=row,
        )
    claimed = cloud.height * cloud.row_step
    if claimed != len(cloud.data):
        raise _wrong(
            f"{cloud.height} rows of {cloud.row_step} bytes are {claimed}, but data holds "
            f"{len(cloud.data)}",
            found=len(cloud.data),
            allowed=claimed,
        )


def _wrong(what: str, **details: Any) -> InvalidInput:
    return InvalidInput(f"the PointCloud2 is not sound: {what}", field="point_cloud2", **details)
