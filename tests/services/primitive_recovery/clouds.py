"""Clouds with known answers."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from shared.superquadric import Superquadric, inside_outside, surface_mesh, volume

Array = NDArray[np.float64]

CAMERA_AXIS = np.array([0.0, 0.0, 1.0])
IDENTITY = (0.0, 0.0, 0.0, 1.0)


def superquadric(
    exponents: tuple[float, float],
    semi_axes: tuple[float, float, float],
    position: tuple[float, float, float] = (0.0, 0.0, 0.0),
    quaternion: tuple[float, float, float, float] = IDENTITY,
) -> Superquadric:
    return Superquadric(exponents, semi_axes, position, quaternion)


def random_superquadric(rng: np.random.Generator) -> Superquadric:
    """In the ranges of the thesis' A.1.2, somewhere before a camera."""
    e1, e2 = rng.uniform(0.1, 2.0, 2)
    a1, a2, a3 = rng.uniform(0.01, 0.15, 3)
    x, y, z = rng.uniform(-0.3, 0.3, 3)
    quaternion = Rotation.from_quat(rng.normal(size=4)).as_quat()
    return Superquadric.from_vector([e1, e2, a1, a2, a3, x, y, z + 0.9, *quaternion])


def surface_points(
    body: Superquadric, count: int, rng: np.random.Generator, *, one_view: bool = False
) -> Array:
    """Return points (count, 3) on the surface: evenly, or as a camera far away along z sees it."""
    vertices, faces = surface_mesh(body, 60, 120)
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    weights = np.linalg.norm(normals, axis=1)
    if one_view:
        weights = np.maximum(-(normals @ CAMERA_AXIS), 0.0)
    chosen = rng.choice(len(faces), count, p=weights / weights.sum())
    u, v = rng.random((2, count))
    outside = u + v > 1
    u[outside], v[outside] = 1 - u[outside], 1 - v[outside]
    a, b, c = corners[chosen].transpose(1, 0, 2)
    return np.asarray(a + u[:, None] * (b - a) + v[:, None] * (c - a))


def overlap(a: Superquadric, b: Superquadric, rng: np.random.Generator) -> float:
    """Return the intersection over union of two bodies."""
    low, high = (f(surface_mesh(a)[0], axis=0) for f in (np.min, np.max))
    box = rng.uniform(low, high, (40_000, 3))
    inside = inside_outside(a, box) < 1
    shared = float((inside & (inside_outside(b, box) < 1)).sum() / inside.sum()) * volume(a)
    return shared / (volume(a) + volume(b) - shared)


def hammer(rng: np.random.Generator) -> Array:
    """Return one view of a hammer: a handle of 200 mm and a head of 90 mm across its end."""
    handle = superquadric((0.2, 1.0), (0.012, 0.012, 0.1), (0.0, 0.0, 0.9))
    head = superquadric((0.2, 0.4), (0.045, 0.02, 0.02), (0.0, 0.0, 1.015))
    turn = Rotation.from_euler("xyz", [70, 10, 25], degrees=True).as_matrix()
    points = []
    for body in (handle, head):
        moved = Superquadric(
            body.exponents,
            body.semi_axes,
            tuple((turn @ (np.array(body.position) - [0, 0, 0.95]) + [0, 0, 0.9]).tolist()),
            tuple(Rotation.from_matrix(turn).as_quat().tolist()),
        )
        points.append(surface_points(moved, 2000, rng, one_view=True))
    return np.vstack(points) + 0.0005 * rng.normal(size=(4000, 3))
