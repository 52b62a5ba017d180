"""Vectors, poses, planes and clouds, between protobuf, JSON and NumPy."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from services.grpc.generated import sparge_pb2 as pb
from shared.errors import InvalidInput
from shared.schemas.grasp import Pose
from shared.schemas.scene import SupportPlane

_POINT_TYPES = {"float32": "<f4", "float64": "<f8"}
_PIXEL_TYPES = {"uint16": "<u2", **_POINT_TYPES}


def vector(values: Sequence[float]) -> pb.Vector3:
    """Return x, y, z as a message."""
    x, y, z = values
    return pb.Vector3(x=x, y=y, z=z)


def pose(of: Pose) -> pb.Pose:
    """Return a pose as a message."""
    x, y, z, w = of.quaternion
    return pb.Pose(position=vector(of.position), quaternion=pb.Quaternion(x=x, y=y, z=z, w=w))


def plane(of: SupportPlane) -> pb.SupportPlane:
    """Return a support plane as a message."""
    return pb.SupportPlane(
        normal=vector(of.normal),
        offset=of.offset,
        inliers=of.inliers,
        residual_mm=of.residual_mm,
    )


def vector_fields(of: pb.Vector3) -> list[float]:
    """Return a vector as JSON has it."""
    return [of.x, of.y, of.z]


def pose_fields(of: pb.Pose) -> dict[str, list[float]]:
    """Return a pose as JSON has it."""
    turn = of.quaternion
    return {
        "position": vector_fields(of.position),
        "quaternion": [turn.x, turn.y, turn.z, turn.w],
    }


def plane_fields(of: pb.SupportPlane) -> dict[str, Any]:
    """Return a support plane as JSON has it."""
    return {
        "normal": vector_fields(of.normal),
        "offset": of.offset,
        "inliers": of.inliers,
        "residual_mm": of.residual_mm,
    }


def points(cloud: pb.PointCloud, field: str) -> NDArray[np.floating[Any]]:
    """Return the rows (N, 3) of a cloud, as they were sent.

    Raises
    ------
    InvalidInput
        The bytes are no whole number of rows.
    """
    kind = cloud.WhichOneof("rows")
    if kind is None:
        return np.empty((0, 3))
    flat = _numbers(getattr(cloud, kind), _POINT_TYPES[kind], f"{field}.{kind}", per_row=3)
    return flat.reshape(-1, 3)


def depth(image: pb.DepthImage) -> dict[str, Any]:
    """Return `depth` (H, W) and, where they are given, `intrinsics` and `depth_scale`.

    Raises
    ------
    InvalidInput
        The bytes or the matrix do not have the size that they should.
    """
    kind = image.WhichOneof("pixels")
    if kind is None:
        raise InvalidInput(f"depth needs pixels: {', '.join(_PIXEL_TYPES)}", field="depth")
    field = f"depth.{kind}"
    flat = _numbers(getattr(image, kind), _PIXEL_TYPES[kind], field)
    if flat.size != image.height * image.width:
        raise InvalidInput(
            f"{field} holds {flat.size} pixels, "
            f"but height and width say {image.height} x {image.width}",
            field=field,
            found=flat.size,
            allowed=image.height * image.width,
        )
    return {"depth": flat.reshape(image.height, image.width), **camera(image, "depth")}


def camera(holder: pb.DepthImage | pb.CloudFile, field: str) -> dict[str, Any]:
    """Return `intrinsics` (3, 3) and `depth_scale` of a depth image, where they are given.

    Raises
    ------
    InvalidInput
        The matrix has not nine entries.
    """
    given: dict[str, Any] = {}
    if holder.intrinsics:
        if len(holder.intrinsics) != 9:
            raise InvalidInput(
                f"{field}.intrinsics has {len(holder.intrinsics)} entries, "
                "allowed are 9: the 3x3 pinhole matrix, row-major",
                field=f"{field}.intrinsics",
                found=len(holder.intrinsics),
                allowed=9,
            )
        given["intrinsics"] = np.array(holder.intrinsics, dtype=np.float64).reshape(3, 3)
    if holder.HasField("depth_scale"):
        given["depth_scale"] = holder.depth_scale
    return given


def _numbers(data: bytes, kind: str, field: str, per_row: int = 1) -> NDArray[Any]:
    row = np.dtype(kind).itemsize * per_row
    if len(data) % row:
        raise InvalidInput(
            f"{field} has {len(data)} bytes, allowed are whole rows of {row}",
            field=field,
            found=len(data),
            allowed=row,
        )
    return np.frombuffer(data, dtype=kind)
