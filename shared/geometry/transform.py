"""A rigid motion that knows its frames: `base_from_camera @ camera_from_grasp`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from shared.errors import InvalidInput
from shared.geometry.se3 import inverse, matrix_from_pose, pose_from_matrix, transform_points

Array = NDArray[np.float64]

TOLERANCE = 1e-3
"""How far from orthonormal the rotation of a matrix may be: calibrations are written down with
few digits."""


@dataclass(frozen=True, eq=False)
class Transform:
    """The pose of the frame `source`, given in the frame `target`.

    It maps coordinates in `source` to coordinates in `target`, and the frames of a product
    must be neighbours: `base_from_camera @ camera_from_grasp` is `base_from_grasp`, the other
    order is refused.

    Attributes
    ----------
    target, source : str
        Names of frames.
    matrix : (4, 4) array
        Homogeneous, metres; read-only.

    Raises
    ------
    InvalidInput
        The matrix is no rigid motion.
    """

    target: str
    source: str
    matrix: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "matrix", _rigid(self.matrix, self.name))

    @classmethod
    def from_pose(
        cls, target: str, source: str, position: ArrayLike, quaternion: ArrayLike
    ) -> Transform:
        """Return the transform of a position (3,) in metres and a quaternion [x, y, z, w]."""
        return cls(target, source, matrix_from_pose(position, quaternion))

    @property
    def name(self) -> str:
        """As in `camera_from_grasp`."""
        return f"{self.target}_from_{self.source}"

    @property
    def position(self) -> Array:
        """Origin (3,) of `source` in `target`, metres."""
        return self.matrix[:3, 3]

    @property
    def rotation(self) -> Array:
        """Columns (3, 3): the axes of `source` in `target`."""
        return self.matrix[:3, :3]

    @property
    def quaternion(self) -> Array:
        """The rotation as [x, y, z, w]."""
        return pose_from_matrix(self.matrix)[1]

    @property
    def inverse(self) -> Transform:
        """The pose of `target` in `source`."""
        return Transform(self.source, self.target, inverse(self.matrix))

    def apply(self, points: ArrayLike) -> Array:
        """Return points (N, 3) of `source` in `target`."""
        return transform_points(self.matrix, np.asarray(points, dtype=np.float64))

    def __matmul__(self, other: Transform) -> Transform:
        if not isinstance(other, Transform):
            return NotImplemented
        if self.source != other.target:
            raise InvalidInput(
                f"{self.name} @ {other.name} is no motion: {self.source!r} and {other.target!r} "
                "are different frames",
                left=self.name,
                right=other.name,
            )
        return Transform(self.target, other.source, self.matrix @ other.matrix)

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        if dtype is None and not copy:
            return self.matrix
        return np.array(self.matrix, dtype=dtype)

    def __repr__(self) -> str:
        x, y, z = self.position
        qx, qy, qz, qw = self.quaternion
        return (
            f"{self.name}: position [{x:.4f}, {y:.4f}, {z:.4f}] m, "
            f"quaternion xyzw [{qx:.4f}, {qy:.4f}, {qz:.4f}, {qw:.4f}]"
        )


def _rigid(matrix: ArrayLike, name: str) -> Array:
    """Return the matrix as a read-only array (4, 4) once it is known to be a rigid motion."""
    held = np.array(matrix, dtype=np.float64)
    if held.shape != (4, 4) or not np.isfinite(held).all():
        raise InvalidInput(f"{name} must be a finite matrix (4, 4); found shape {held.shape}")
    rotation = held[:3, :3]
    error = float(np.abs(rotation @ rotation.T - np.eye(3)).max())
    if error > TOLERANCE or np.linalg.det(rotation) < 0 or not _is_last_row(held[3]):
        raise InvalidInput(
            f"{name} is no rigid motion: its rotation is off by {error:.2g}, its determinant is "
            f"{np.linalg.det(rotation):.2g}, its last row is {held[3].tolist()}"
        )
    held.flags.writeable = False
    return held


def _is_last_row(row: Array) -> bool:
    return bool(np.abs(row - [0, 0, 0, 1]).max() < 1e-9)
