"""Points on primitives."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.geometry.rotation import quaternion_from_matrix
from shared.geometry.se3 import pose_matrix
from shared.schemas.primitive import Primitive
from shared.superquadric import Superquadric, surface_mesh

Array = NDArray[np.float64]

HANDLE = Superquadric((0.3, 1.0), (0.012, 0.012, 0.08), (0.0, 0.0, 0.0), (0, 0, 0, 1))
HEAD = Superquadric((0.3, 0.3), (0.02, 0.05, 0.02), (0.0, 0.0, 0.1), (0, 0, 0, 1))


def as_primitive(number: int, shape: Superquadric) -> Primitive:
    return Primitive(
        id=number,
        parameters=tuple(shape.to_vector().tolist()),
        shape_class="cylinder",
        shape_probability=1.0,
        full_extents=shape.full_extents,
        residual_mm=0.0,
        support=1,
    )


def moved(shape: Superquadric, motion: Array) -> Superquadric:
    pose = motion @ shape.pose
    position, quaternion = pose[:3, 3], quaternion_from_matrix(pose[:3, :3])
    return Superquadric(
        shape.exponents, shape.semi_axes, tuple(position.tolist()), tuple(quaternion.tolist())
    )


def surface_points(shape: Superquadric) -> Array:
    return surface_mesh(shape, rings=10, segments=16)[0]


def some_motion() -> Array:
    angle = 0.7
    turn = np.array(
        [[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]]
    )
    return pose_matrix([0.3, -0.2, 0.9], turn)
