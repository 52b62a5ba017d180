"""Frames that a part may be aligned with."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.fitting.extremes import frame_about, smallest_rectangle
from shared.geometry.points import principal_axes

Array = NDArray[np.float64]

_TURNS = 18
_UPRIGHT = 0.998
_FLIP = np.array([-1.0, 1.0, 1.0])


def candidate_frames(points: Array, normal: Array | None) -> Array:
    """Return rotations (F, 3, 3) whose columns may be the part's axes, of points (n, 3).

    With a support plane, or a direction up: first the one about its normal, turned so that
    the rectangle around the points is smallest. About the longest principal axis, with one
    axis level. And about the shortest one, for flat parts.
    """
    _, axes = principal_axes(points)
    long, middle, short = np.ascontiguousarray(axes.T)
    frames = [_turned(points, short, long)]
    if normal is None:
        return np.array([*frames, _turned(points, long, middle)])
    if abs(float(long @ normal)) < _UPRIGHT:
        # About the long axis; its first axis is level.
        upward = normal - long * float(long @ normal)
        frames.insert(0, np.ascontiguousarray(frame_about(long, upward)[:, [1, 0, 2]] * _FLIP))
        return np.array([_turned(points, normal, long), *frames])
    return np.array([_turned(points, normal, middle), *frames])


def _turned(points: Array, z_axis: Array, x_hint: Array) -> Array:
    """Return the frame about an axis whose rectangle around the points is smallest."""
    frame = frame_about(np.ascontiguousarray(z_axis), np.ascontiguousarray(x_hint))
    angle = smallest_rectangle(np.ascontiguousarray(points @ frame[:, :2]), _TURNS)
    cos, sin = np.cos(angle), np.sin(angle)
    return np.asarray(frame @ np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]))
