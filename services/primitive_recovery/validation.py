"""Which clouds a superquadric can be recovered from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.points import second_moments
from shared.errors import DegenerateCloud, EmptyCloud, InvalidInput, PayloadTooLarge, WrongUnits
from shared.geometry.passes import about_mean
from shared.geometry.points import bounds
from shared.schemas.fields import FARTHEST_M

Array = NDArray[np.float64]

LEAST_POINTS = 11
"""One per unknown of a superquadric."""
LARGEST_OBJECT = 5.0
"""Metres; what is larger is no object for a robot's hand."""

_FLAT = 1e-5
_SMALLEST_OBJECT = 1e-6


def checked_cloud(points: Array, max_points: int) -> Array:
    """Return points (N, 3) as a writable copy if a superquadric can be recovered from them.

    Raises
    ------
    EmptyCloud, InvalidInput, DegenerateCloud, WrongUnits, PayloadTooLarge
        Too few points; NaN or infinity; all on a plane, a line or a spot; larger
        than any object; too many.
    """
    if len(points) < LEAST_POINTS:
        raise EmptyCloud(
            f"points: {len(points)} found, a superquadric needs {LEAST_POINTS} at least.",
            field="points",
            found=len(points),
            allowed=f">= {LEAST_POINTS}",
        )
    if len(points) > max_points:
        raise PayloadTooLarge(
            f"points: {len(points)} found, at most {max_points} are taken; thin them out.",
            field="points",
            found=len(points),
            allowed=f"<= {max_points}",
        )
    finite = np.isfinite(points)
    if not finite.all():
        bad = int((~finite.all(axis=1)).sum())
        raise InvalidInput(
            f"points: {bad} of {len(points)} rows are NaN or infinite; leave them out.",
            field="points",
            found=bad,
            allowed=0,
        )
    _check_size(points)
    points = np.array(points, dtype=np.float64, order="C")
    flat = flatness(points)
    if flat is not None:
        raise DegenerateCloud(
            f"points: all of them lie on {flat}; there is no volume to recover.",
            field="points",
            found=flat,
        )
    return points


def checked_obstacles(points: Array | None, max_points: int) -> Array | None:
    """Return the points (M, 3) of other things if they can be rays of the sensor.

    Raises
    ------
    InvalidInput, PayloadTooLarge
        NaN or infinity, or absurdly far away; too many.
    """
    if points is None or not len(points):
        return None
    if len(points) > max_points:
        raise PayloadTooLarge(
            f"obstacle_points: {len(points)} found, at most {max_points} are taken; thin them out.",
            field="obstacle_points",
            found=len(points),
            allowed=f"<= {max_points}",
        )
    bad = int((~np.isfinite(points).all(axis=1)).sum())
    if bad:
        raise InvalidInput(
            f"obstacle_points: {bad} of {len(points)} rows are NaN or infinite; leave them out.",
            field="obstacle_points",
            found=bad,
            allowed=0,
        )
    if (far := float(np.abs(points).max())) > FARTHEST_M:
        raise InvalidInput(
            f"obstacle_points: one is {far:.4g} m away; are they in metres?",
            field="obstacle_points",
            found=far,
            allowed=FARTHEST_M,
        )
    return np.array(points, dtype=np.float64, order="C")


def flatness(points: Array) -> str | None:
    """Return what finite points (N, 3) all lie on, "a spot", "a line" or "a plane", or None."""
    _, centred = about_mean(points)
    size = float(np.abs(centred).max())
    if size < _SMALLEST_OBJECT:
        return "a spot"
    centred = centred / size
    covariance = second_moments(centred) / len(points)
    spread = np.sqrt(np.linalg.eigvalsh(covariance).clip(min=0.0))
    if spread[1] < _FLAT * spread[2]:
        return "a line"
    if spread[0] < _FLAT * spread[2]:
        return "a plane"
    return None


def _check_size(points: Array) -> None:
    with np.errstate(over="ignore"):
        extent = min(float(bounds(points)[1].max()), 1e308)
    if extent > LARGEST_OBJECT:
        raise WrongUnits(
            f"points: they spread over {extent:.4g} m, more than any object that can be grasped "
            f"({LARGEST_OBJECT:g} m). Are they in millimetres? Give metres.",
            field="points",
            found=extent,
            allowed=f"<= {LARGEST_OBJECT:g} m",
        )
    far = float(np.abs(points).max())
    if far > 1e6 * extent and extent > 0:
        raise DegenerateCloud(
            f"points: {far:.4g} m from the origin, they spread over {extent:.4g} m only; "
            "their coordinates are too coarse to tell a shape.",
            field="points",
            found=extent,
        )
