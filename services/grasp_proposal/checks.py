"""What a request must hold before anything is computed from it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.errors import EmptyCloud, InvalidInput
from shared.geometry.rotation import unit
from shared.schemas.grasp import ProposeRequest

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

MIN_POINTS = 10
_MAX_COORDINATE = 1e4


def checked_points(request: ProposeRequest) -> tuple[Array, Mask]:
    """Return the object's points (N, 3) and where grasps are wanted (N,).

    Raises
    ------
    EmptyCloud
        Fewer than ten points.
    InvalidInput
        Non-finite or absurdly far points, a focus of another length or without
        a point.
    """
    for name in ("points", "obstacle_points"):
        array = getattr(request, name)
        if array is None:
            continue
        if not np.isfinite(array).all():
            raise InvalidInput(f"{name} must be finite", field=name, allowed="finite metres")
        if len(array) and np.abs(array).max() > _MAX_COORDINATE:
            raise InvalidInput(
                f"{name} reach {np.abs(array).max():.3g} m; are they in metres?",
                field=name,
                found=float(np.abs(array).max()),
                allowed=_MAX_COORDINATE,
            )
    points = request.points
    if len(points) < MIN_POINTS:
        raise EmptyCloud(
            f"points holds {len(points)} points, at least {MIN_POINTS} are needed",
            field="points",
            found=len(points),
            allowed=MIN_POINTS,
        )
    if request.focus is None:
        return points, np.ones(len(points), dtype=np.bool_)
    if len(request.focus) != len(points):
        raise InvalidInput(
            f"focus has {len(request.focus)} entries for {len(points)} points",
            field="focus",
            found=len(request.focus),
            allowed=len(points),
        )
    if not request.focus.any():
        raise InvalidInput("focus has no true entry: there is nothing to grasp", field="focus")
    return points, request.focus


def checked_up(request: ProposeRequest) -> tuple[Array | None, float | None]:
    """Return the unit up direction and the support plane's offset, where they are known.

    Raises
    ------
    InvalidInput
        A direction of length zero.
    """
    if request.plane is not None:
        normal = np.asarray(request.plane.normal, dtype=np.float64)
        length = float(np.linalg.norm(normal))
        if not length > 0:
            raise InvalidInput("the plane's normal must not be zero", field="plane.normal")
        return normal / length, request.plane.offset / length
    if request.up is not None:
        if not np.linalg.norm(request.up) > 0:
            raise InvalidInput("up must not be zero", field="up")
        return unit(request.up), None
    return None, None
