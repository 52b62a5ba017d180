"""Point clouds and depth images from the files that people have: PLY, PCD, XYZ, NPZ, PNG.

Nothing here trusts the bytes: what a header claims is held against what is
there before memory is taken for it.
"""

from __future__ import annotations

import io
import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import PurePath
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shared.errors import InvalidInput, UnsupportedMediaType
from shared.wire.depth_png import read_depth_png
from shared.wire.npz import read_npz
from shared.wire.pcd import read_pcd
from shared.wire.ply import read_ply
from shared.wire.text_table import data_lines, read_columns

EXTENSIONS = (".ply", ".pcd", ".xyz", ".npz", ".png")
DEFAULT_MAX_UNPACKED_BYTES = 256 * 2**20


@dataclass(frozen=True)
class CloudFile:
    """What a file holds: either points, or a depth image with its intrinsics.

    Attributes
    ----------
    points : (N, 3) float64 array or None
        In metres if the file is; rows may be non-finite (no return).
    depth : (H, W) array or None
        Of the file's own number type; integer depth counts in `depth_scale`.
    intrinsics : (3, 3) float64 array or None
        Pinhole matrix in pixels.
    depth_scale : float or None
        Metres per unit of depth.
    """

    points: NDArray[np.float64] | None = None
    depth: NDArray[Any] | None = None
    intrinsics: NDArray[np.float64] | None = None
    depth_scale: float | None = None

    def fields(self) -> dict[str, Any]:
        """Return what is there, by the names of `shared.schemas.scene.View`."""
        everything = {
            "points": self.points,
            "depth": self.depth,
            "intrinsics": self.intrinsics,
            "depth_scale": self.depth_scale,
        }
        return {name: value for name, value in everything.items() if value is not None}


def read_cloud_file(
    name: str,
    data: bytes,
    *,
    intrinsics: ArrayLike | None = None,
    depth_scale: float | None = None,
    max_unpacked_bytes: int = DEFAULT_MAX_UNPACKED_BYTES,
) -> CloudFile:
    """Return the points or the depth image of a file.

    Parameters
    ----------
    name : str
        File name; its extension says the format, one of `EXTENSIONS`.
    data : bytes
        The file.
    intrinsics : (3, 3) array_like, optional
        Pinhole matrix in pixels, for depth in a file that does not hold it.
    depth_scale : float, optional
        Metres per unit of depth, likewise.
    max_unpacked_bytes : int
        Bound on the size of what comes out.

    Raises
    ------
    UnsupportedMediaType
        The extension is not one of `EXTENSIONS`.
    MalformedRequest
        The bytes are not a complete file of that format.
    InvalidInput
        They are, but hold no points or depth that can be used.
    PayloadTooLarge
        They would unpack to more than allowed.
    """
    extension = extension_of(name)
    match extension:
        case ".ply":
            return CloudFile(points=read_ply(data, max_unpacked_bytes))
        case ".pcd":
            return CloudFile(points=read_pcd(data, max_unpacked_bytes))
        case ".xyz":
            return CloudFile(points=_read_xyz(data, max_unpacked_bytes))
        case ".npz":
            arrays = read_npz(data, max_unpacked_bytes)
            if ("points" in arrays) == ("depth" in arrays):
                raise InvalidInput(
                    "the npz file must hold either 'points' or 'depth'; "
                    f"it holds {sorted(arrays)[:20]}",
                    field="file",
                    found=sorted(arrays)[:20],
                    allowed=["points", "depth"],
                )
            if "points" in arrays:
                return CloudFile(points=_checked(arrays["points"], "points", ("N", 3)))
            given = {"intrinsics": intrinsics, "depth_scale": depth_scale} | arrays
            return _depth_file(arrays["depth"], given)
        case ".png":
            depth = read_depth_png(data, max_unpacked_bytes)
            return _depth_file(depth, {"intrinsics": intrinsics, "depth_scale": depth_scale})
    kind = f"of type {extension[:20]!r}" if extension else "without an extension"
    raise UnsupportedMediaType(
        f"files {kind} are not read here; known are {', '.join(EXTENSIONS)}",
        found=extension[:20],
        allowed=list(EXTENSIONS),
    )


def extension_of(name: str) -> str:
    """Return the extension of a file's name, in lower case and with its dot; "" for none."""
    return PurePath(name.replace("\x00", "")).suffix.lower()


def _read_xyz(data: bytes, max_unpacked_bytes: int) -> NDArray[np.float64]:
    lines = data_lines(io.BytesIO(data), "the XYZ file")
    first = next(lines, None)
    if first is None:
        return np.empty((0, 3))
    is_title = [each.lower() for each in first.split()[:3]] == ["x", "y", "z"]
    rest = lines if is_title else itertools.chain([first], lines)
    return read_columns(rest, (0, 1, 2), "the XYZ file", max_bytes=max_unpacked_bytes)


def _depth_file(depth: NDArray[Any], given: Mapping[str, Any]) -> CloudFile:
    if depth.dtype.kind not in "fiu" or depth.ndim != 2:
        raise InvalidInput(
            f"depth is {depth.dtype} of shape {depth.shape}, allowed is (H, W) of real numbers",
            field="depth",
        )
    if given["intrinsics"] is None:
        raise InvalidInput(
            "a depth image needs 'intrinsics', the 3x3 pinhole matrix in pixels",
            field="intrinsics",
        )
    matrix = _checked(given["intrinsics"], "intrinsics", (3, 3))
    if not (np.isfinite(matrix).all() and matrix[0, 0] > 0 and matrix[1, 1] > 0):
        raise InvalidInput(
            "intrinsics must be finite with positive focal lengths", field="intrinsics"
        )
    if given["depth_scale"] is None:
        if depth.dtype.kind != "f":
            raise InvalidInput(
                "an integer depth image needs 'depth_scale', metres per unit", field="depth_scale"
            )
        return CloudFile(depth=depth, intrinsics=matrix)
    scale = _checked(given["depth_scale"], "depth_scale", ())
    if not (np.isfinite(scale) and scale > 0):
        raise InvalidInput(
            f"depth_scale is {float(scale)}, allowed is a finite number above 0",
            field="depth_scale",
        )
    return CloudFile(depth=depth, intrinsics=matrix, depth_scale=float(scale))


def _checked(value: ArrayLike, name: str, shape: tuple[int | str, ...]) -> NDArray[np.float64]:
    """Return `value` as float64 if it is real numbers of this shape ("N": any length)."""
    try:
        array = np.asarray(value)
    except (ValueError, TypeError, OverflowError):
        raise InvalidInput(f"{name} is not a regular array of numbers", field=name) from None
    fits = array.ndim == len(shape) and all(
        isinstance(want, str) or want == have for want, have in zip(shape, array.shape, strict=True)
    )
    if array.dtype.kind not in "fiu" or not fits:
        wanted = str(shape).replace("'", "")
        raise InvalidInput(
            f"{name} is {str(array.dtype)[:40]} of shape {array.shape}, "
            f"allowed is {wanted} of real numbers",
            field=name,
            found=str(array.shape),
            allowed=wanted,
        )
    with np.errstate(over="ignore", invalid="ignore"):
        return array.astype(np.float64)
