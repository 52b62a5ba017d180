"""Rotation matrices and quaternions `[x, y, z, w]`."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

Matrix = NDArray[np.float64]


def quaternion_from_matrix(rotation: Matrix) -> Matrix:
    """Return unit quaternions (..., 4) with w >= 0 of rotation matrices (..., 3, 3)."""
    return np.asarray(Rotation.from_matrix(rotation).as_quat(canonical=True))


def matrix_from_quaternion(quaternion: ArrayLike) -> Matrix:
    """Return rotation matrices (..., 3, 3) of quaternions (..., 4), of any length but zero.

    By the formula, not SciPy's `Rotation`, whose conversions take 70 microseconds a call:
    the reasoning makes two dozen matrices for a decision of a few milliseconds.

    Raises
    ------
    ValueError
        A quaternion is zero.
    """
    q = np.asarray(quaternion, dtype=np.float64)
    square = (q * q).sum(axis=-1)
    if not np.all(square > 0):
        raise ValueError("a quaternion is zero")
    x, y, z, w = np.moveaxis(q, -1, 0)
    s = 2 / square
    matrix = np.empty((*q.shape[:-1], 3, 3))
    matrix[..., 0, 0] = 1 - s * (y * y + z * z)
    matrix[..., 0, 1] = s * (x * y - z * w)
    matrix[..., 0, 2] = s * (x * z + y * w)
    matrix[..., 1, 0] = s * (x * y + z * w)
    matrix[..., 1, 1] = 1 - s * (x * x + z * z)
    matrix[..., 1, 2] = s * (y * z - x * w)
    matrix[..., 2, 0] = s * (x * z - y * w)
    matrix[..., 2, 1] = s * (y * z + x * w)
    matrix[..., 2, 2] = 1 - s * (x * x + y * y)
    return matrix


def unit(vector: ArrayLike) -> Matrix:
    """Return vectors (..., 3) scaled to length 1; a zero vector stays zero."""
    v = np.asarray(vector, dtype=np.float64)
    largest = np.abs(v).max(axis=-1, keepdims=True)  # first, so that squares do not underflow
    v = np.divide(v, largest, out=np.zeros_like(v), where=largest > 0)
    length = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.asarray(np.divide(v, length, out=np.zeros_like(v), where=length > 0))


def any_perpendicular(direction: ArrayLike) -> Matrix:
    """Return a unit vector (3,) perpendicular to `direction` (3,)."""
    d = unit(direction)
    axis = np.zeros(3)
    axis[np.argmin(np.abs(d))] = 1.0
    return unit(np.cross(d, axis))


def frame_from_z(z_axis: ArrayLike, x_hint: ArrayLike | None = None) -> Matrix:
    """Return a right-handed rotation (3, 3) whose third column is `z_axis`.

    Parameters
    ----------
    z_axis : (3,) array_like
        Direction of the third axis, of any length but zero.
    x_hint : (3,) array_like, optional
        The first axis is this, made perpendicular to `z_axis`; ignored when parallel.
    """
    z = unit(z_axis)
    x = any_perpendicular(z)
    if x_hint is not None:
        hint = unit(x_hint)
        flat = hint - z * (hint @ z)
        if np.linalg.norm(flat) > 1e-9:
            x = unit(flat)
            x = unit(x - z * (x @ z))  # again: the first loses digits when nearly parallel
    return np.column_stack([x, np.cross(z, x), z])
