"""What the sensor truly saw: the valid points of a view, and where the sensor looked."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.perception.units import require_metres
from shared.errors import EmptyCloud, InvalidInput, PayloadTooLarge
from shared.geometry.points import points_from_depth
from shared.geometry.rotation import unit
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
    ranges : (M,) array
        Distance of each point from the sensor.
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
    ranges: Array
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
    everything, viewpoint = _points_and_viewpoint(view)
    require_metres(everything, kind, field)
    rows = np.flatnonzero(_all_columns(np.abs(everything) < MAX_COORDINATE_M))
    points = everything.take(rows, axis=0)
    if len(rows) < min_points:
        raise EmptyCloud(
            f"{len(rows)} valid points of {len(everything)}, at least {min_points} are needed; "
            "a point is invalid when a coordinate is not finite, a pixel when it has no return",
            field=field,
            found=len(rows),
            allowed=min_points,
            input_points=len(everything),
        )
    rays = points - viewpoint if viewpoint.any() else points
    ranges = np.sqrt(np.einsum("ij,ij->i", rays, rays))
    if view.depth is not None:
        gaze = _image_centre(view)
    else:
        gaze = unit(np.einsum("i,ij->j", 1.0 / np.maximum(ranges, 1e-9), rays))
    return Observation(points, rows, ranges, viewpoint, gaze, len(everything))


def _all_columns(table: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return `table.all(axis=1)` of a (N, 3) table, ten times as fast."""
    return np.asarray(table[:, 0] & table[:, 1] & table[:, 2])


def _points_and_viewpoint(view: View) -> tuple[Array, Array]:
    if view.depth is None or view.intrinsics is None:
        return np.asarray(view.points, dtype=np.float64), np.asarray(view.viewpoint)
    depth = view.depth
    if depth.dtype.kind == "u":
        depth = np.where(depth == np.iinfo(depth.dtype).max, 0, depth)
    scale = 1.0 if view.depth_scale is None else view.depth_scale
    with np.errstate(over="ignore", invalid="ignore"):
        return points_from_depth(depth, view.intrinsics, scale), np.zeros(3)


def _image_centre(view: View) -> Array:
    assert view.depth is not None
    assert view.intrinsics is not None
    (height, width), k = view.depth.shape, view.intrinsics
    y = ((height - 1) / 2 - k[1, 2]) / k[1, 1]
    x = ((width - 1) / 2 - k[0, 2] - k[0, 1] * y) / k[0, 0]
    return unit([x, y, 1.0])
