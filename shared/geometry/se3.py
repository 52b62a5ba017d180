"""Rigid motions as 4x4 matrices: `world_from_object @ object_from_grasp`."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shared.geometry.rotation import matrix_from_quaternion, quaternion_from_matrix

Matrix = NDArray[np.float64]


def pose_matrix(position: ArrayLike, rotation: ArrayLike) -> Matrix:
    """Return the motion (4, 4) with this translation (3,) and rotation (3, 3)."""
    motion = np.eye(4)
    motion[:3, :3] = rotation
    motion[:3, 3] = position
    return motion


def matrix_from_pose(position: ArrayLike, quaternion: ArrayLike) -> Matrix:
    """Return the motion (4, 4) of a position (3,) and a quaternion (4,)."""
    return pose_matrix(position, matrix_from_quaternion(quaternion))


def pose_from_matrix(motion: Matrix) -> tuple[Matrix, Matrix]:
    """Return position (3,) and quaternion (4,) of a motion (4, 4)."""
    return motion[:3, 3].copy(), quaternion_from_matrix(motion[:3, :3])


def inverse(motion: Matrix) -> Matrix:
    """Return the inverse of a rigid motion (4, 4)."""
    rotation = motion[:3, :3].T
    return pose_matrix(-rotation @ motion[:3, 3], rotation)


def transform_points(motion: Matrix, points: Matrix) -> Matrix:
    """Return points (N, 3) moved by a rigid motion (4, 4)."""
    return np.asarray(points @ motion[:3, :3].T + motion[:3, 3])
