"""Single bodies before a sensor, some on a table."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from services.primitive_recovery.fitting import PartFit, fit_part
from shared.schemas.scene import SupportPlane
from shared.superquadric import Superquadric, surface_mesh

Array = NDArray[np.float64]

TABLE = SupportPlane(normal=(0.0, 0.0, 1.0), offset=0.0, inliers=1000, residual_mm=0.0)
HEAD = np.array([-0.6, 0.0, 0.5])
"""A sensor that looks down at the origin, 40 degrees above the table z = 0."""


def body(
    exponents: tuple[float, float],
    full_extents: tuple[float, float, float],
    position: tuple[float, float, float],
    angles_deg: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> Superquadric:
    """Return a superquadric of full extents in millimetres, turned by x-y-z angles."""
    semi_axes = [size / 2000 for size in full_extents]
    quaternion = Rotation.from_euler("xyz", angles_deg, degrees=True).as_quat()
    return Superquadric.from_vector([*exponents, *semi_axes, *position, *quaternion])


def seen(
    thing: Superquadric, viewpoint: Array, count: int, rng: np.random.Generator, noise: float = 0.0
) -> Array:
    """Return points (count, 3) of the visible surface, as dense as pixels; noise along rays."""
    vertices, faces = surface_mesh(thing, 80, 160)
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    to_sensor = viewpoint - corners.mean(axis=1)
    weight = np.maximum(np.einsum("ij,ij->i", normals, to_sensor), 0.0)
    chosen = rng.choice(len(faces), count, p=weight / weight.sum())
    u, v = rng.random((2, count))
    outside = u + v > 1
    u[outside], v[outside] = 1 - u[outside], 1 - v[outside]
    a, b, c = corners[chosen].transpose(1, 0, 2)
    points = a + u[:, None] * (b - a) + v[:, None] * (c - a)
    rays = points - viewpoint
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    return np.asarray(points + noise * rng.normal(size=(count, 1)) * rays)


def sizes(fit: PartFit) -> Array:
    """Return the full extents (3,) in millimetres, smallest first."""
    return np.sort(1e3 * np.array(fit.superquadric.full_extents))


@dataclass(frozen=True)
class Setting:
    """Everything that `fit_part` is told, so that it can be moved, scaled and reordered."""

    points: Array
    viewpoint: Array
    normal: Array
    offset: float
    noise_mm: float = 0.0

    def fit(self, seed: int = 0) -> PartFit:
        plane = SupportPlane(
            normal=(float(self.normal[0]), float(self.normal[1]), float(self.normal[2])),
            offset=self.offset,
            inliers=1000,
            residual_mm=self.noise_mm,
        )
        rng = np.random.default_rng(seed)
        return fit_part(self.points, viewpoint=self.viewpoint, plane=plane, rng=rng)

    def moved(self, rotation: Array, shift: Array) -> Setting:
        normal = rotation @ self.normal
        return Setting(
            self.points @ rotation.T + shift,
            rotation @ self.viewpoint + shift,
            normal,
            self.offset - float(normal @ shift),
            self.noise_mm,
        )

    def scaled(self, factor: float) -> Setting:
        return Setting(
            factor * self.points,
            factor * self.viewpoint,
            self.normal,
            factor * self.offset,
            factor * self.noise_mm,
        )
