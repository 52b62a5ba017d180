"""What a request must hold before anything is computed from it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.errors import EmptyCloud, InvalidInput
from shared.geometry.points import bounds
from shared.schemas.grasp import ProposeRequest
from shared.superquadric import Superquadric

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

MIN_POINTS = 10
_MAX_COORDINATE = 1e4
_EXPONENTS = 0.01, 4.0
"""Wider than a recovery gives; beyond them powers of them leave the range of numbers."""


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


def checked_superquadrics(request: ProposeRequest, points: Array) -> tuple[Superquadric, ...]:
    """Return what was recovered from the points (N, 3), if the request says so.

    Raises
    ------
    InvalidInput
        Not finite, exponents or sizes that no shape has, a quaternion of zeros, or farther from
        the points' box than that is long: in another frame, or another object's.
    """
    rows = request.superquadrics
    if rows is None:
        return ()
    least, most = _EXPONENTS
    sound = (
        np.isfinite(rows).all()
        and ((rows[:, :2] >= least) & (rows[:, :2] <= most)).all()
        and (rows[:, 2:5] > 0).all()
        and (np.abs(rows) <= _MAX_COORDINATE).all()
        and rows[:, 8:].any(axis=1).all()
    )
    if not sound:
        raise InvalidInput(
            f"superquadrics must be finite, exponents in {least}..{most}, semi-axes positive, "
            f"quaternions not zero, nothing beyond {_MAX_COORDINATE:g}",
            field="superquadrics",
        )
    low, extents = bounds(points)
    high = low + extents
    off = np.linalg.norm(rows[:, 5:8] - np.clip(rows[:, 5:8], low, high), axis=1)
    if len(off) and off.max() > np.linalg.norm(high - low):
        raise InvalidInput(
            f"a superquadric is {off.max():.3g} m away from the points; is it in their frame?",
            field="superquadrics",
            found=float(off.max()),
            allowed=float(np.linalg.norm(high - low)),
        )
    return tuple(Superquadric.from_vector(row) for row in rows)


def checked_viewpoint(request: ProposeRequest) -> Array:
    """Return the sensor's position (3,).

    Raises
    ------
    InvalidInput
        Absurdly far away.
    """
    viewpoint = np.asarray(request.viewpoint, dtype=np.float64)
    if np.abs(viewpoint).max() > _MAX_COORDINATE:
        raise InvalidInput(
            f"viewpoint is {np.abs(viewpoint).max():.3g} m away",
            field="viewpoint",
            found=viewpoint.tolist(),
            allowed=_MAX_COORDINATE,
        )
    return viewpoint
