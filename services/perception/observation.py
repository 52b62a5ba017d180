"""What the sensor truly saw: the valid points of a view, and where the sensor looked."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.perception.pixels import distances, points_of_depth, points_within
from services.perception.units import require_metres
from shared.errors import EmptyCloud, InvalidInput, PayloadTooLarge
from shared.geometry.rotation import unit
from shared.jit import read_only
from shared.schemas.scene import InputKind, View

Array = NDArray[np.float64]
Rows = NDArray[np.intp]

MAX_COORDINATE_M = 1e3
"""A lone point further out than this is not a measurement."""


@dataclass(frozen=True)
class Observation:
    """The valid points of one view.

    Attributes
    ----------
    points : (M, 3) array
        Metres, in the view's frame; all finite.
    rows : (M,) array
        Row of each point in the input.
    viewpoint : (3,) array
        Position of the sensor.
    gaze : (3,) array
        Unit direction in which the sensor looks: through the centre of a depth
        image; for bare points, the mean direction in which they were seen.
    total : int
        Number of points in the input, valid or not.
    """

    points: Array
    rows: Rows
    viewpoint: Array
    gaze: Array
    total: int


def observe(view: View, kind: InputKind, min_points: int, max_points: int) -> Observation:
    """Return the valid points of `view`.

    A pixel of zero, negative or non-finite depth, or of the largest value of an
    integer type (saturation), is no return. The camera of a depth image sits at the
    origin of the view's frame whatever `view.viewpoint` says.

    Raises
    ------
    PayloadTooLarge
        More than `max_points` points or pixels.
    InvalidInput
        A viewpoint that is nowhere near.
    EmptyCloud
        Fewer than `min_points` valid points.
    WrongUnits
        The extent makes sense in millimetres only.
    """
    field = "points" if view.depth is None else "depth"
    given = view.points if view.depth is None else view.depth
    count = 0 if given is None else given.size // (3 if view.depth is None else 1)
    if count > max_points:
        raise PayloadTooLarge(
            f"{field} hold {count} points, at most {max_points} are accepted",
            field=field,
            found=count,
            allowed=max_points,
        )
    if max(map(abs, view.viewpoint)) > MAX_COORDINATE_M:
        raise InvalidInput(
            f"viewpoint {list(view.viewpoint)} is not within {MAX_COORDINATE_M:g} m of the origin",
            field="viewpoint",
            found=list(view.viewpoint),
            allowed=f"metres, up to {MAX_COORDINATE_M:g}",
        )
    points, rows, reach, viewpoint = _finite_points(view)
    require_metres(points, kind, field)
    if reach >= MAX_COORDINATE_M:
        points, kept, _ = points_within(read_only(points), MAX_COORDINATE_M)
        rows = rows[kept]
    if len(rows) < min_points:
        raise EmptyCloud(
            f"{len(rows)} valid points of {count}, at least {min_points} are needed; "
            "a point is invalid when a coordinate is not finite, a pixel when it has no return",
            field=field,
            found=len(rows),
            allowed=min_points,
            input_points=count,
        )
    if view.depth is not None:
        gaze = _image_centre(view)
    else:
        ranges = distances(points, viewpoint)
        gaze = unit(np.einsum("i,ij->j", 1.0 / np.maximum(ranges, 1e-9), points - viewpoint))
    return Observation(points, rows, viewpoint, gaze, count)


def _finite_points(view: View) -> tuple[Array, Rows, float, Array]:
    """Return the finite points (M, 3), their rows (M,) in the input, the reach, the viewpoint."""
    if view.depth is None or view.intrinsics is None:
        given = read_only(np.empty((0, 3)) if view.points is None else view.points)
        return *points_within(given, np.inf), np.asarray(view.viewpoint, dtype=np.float64)
    kind = view.depth.dtype
    saturated = float(np.iinfo(kind).max) if kind.kind == "u" else np.nan
    scale = 1.0 if view.depth_scale is None else float(view.depth_scale)
    depth, intrinsics = read_only(view.depth), read_only(view.intrinsics)
    return *points_of_depth(depth, intrinsics, scale, saturated), np.zeros(3)


def _image_centre(view: View) -> Array:
    assert view.depth is not None
    assert view.intrinsics is not None
    (height, width), k = view.depth.shape, view.intrinsics
    y = ((height - 1) / 2 - k[1, 2]) / k[1, 1]
    x = ((width - 1) / 2 - k[0, 2] - k[0, 1] * y) / k[0, 0]
    return unit([x, y, 1.0])
