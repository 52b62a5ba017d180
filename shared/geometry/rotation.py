"""Rotation matrices and quaternions `[x, y, z, w]`."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

Matrix = NDArray[np.float64]

_UNTURNED = np.eye(3)


def _turn() -> Matrix:
    """Return what each of the 16 products of components adds to each of the 9 entries."""
    turn = np.zeros((4, 4, 3, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        turn[i, i, [j, k], [j, k]] = -1.0
        turn[i, j, [i, j], [j, i]] = 1.0
        turn[k, 3, [i, j], [j, i]] = -1.0, 1.0
    return turn.reshape(16, 9)


_TURN = _turn()


def quaternion_from_matrix(rotation: Matrix) -> Matrix:
    """Return unit quaternions (..., 4) with w >= 0 of rotation matrices (..., 3, 3)."""
    return np.asarray(Rotation.from_matrix(rotation).as_quat(canonical=True))


def matrix_from_quaternion(quaternion: ArrayLike) -> Matrix:
    """Return rotation matrices (..., 3, 3) of quaternions (..., 4), of any length but zero.

    By the formula, not SciPy's `Rotation`, whose conversions take 70 microseconds a call:
    the reasoning makes two dozen matrices for a decision of a few milliseconds. Each entry is
    a sum of products of two components, so all of them are one product with a table.

    Raises
    ------
    ValueError
        A quaternion is zero.
    """
    q = np.asarray(quaternion, dtype=np.float64)
    square = (q * q).sum(axis=-1)
    if not np.all(square > 0):
        raise ValueError("a quaternion is zero")
    products = q[..., :, None] * (q * (2 / square)[..., None])[..., None, :]
    turned = products.reshape(*q.shape[:-1], 16) @ _TURN
    return np.asarray(turned.reshape(*q.shape[:-1], 3, 3) + _UNTURNED)


def unit(vector: ArrayLike) -> Matrix:
    """Return vectors (..., 3) scaled to length 1; a zero vector stays zero."""
    v = np.asarray(vector, dtype=np.float64)
    largest = np.abs(v).max(axis=-1, keepdims=True)  # first, so that squares do not underflow
    v = np.divide(v, largest, out=np.zeros_like(v), where=largest > 0)
    length = np.sqrt((v * v).sum(axis=-1, keepdims=True))
    return np.asarray(np.divide(v, length, out=np.zeros_like(v), where=length > 0))


def any_perpendicular(direction: ArrayLike) -> Matrix:
    """Return a unit vector (3,) perpendicular to `direction` (3,)."""
    d = unit(direction)
    axis = np.zeros(3)
    axis[np.argmin(np.abs(d))] = 1.0
    return unit(_cross(d, axis))


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
    return np.column_stack([x, _cross(z, x), z])


def _cross(a: Matrix, b: Matrix) -> Matrix:
    """Return `numpy.cross` of two vectors (3,), in a tenth of its time."""
    (ax, ay, az), (bx, by, bz) = a.tolist(), b.tolist()
    return np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])
