"""Superquadrics: one value object, the implicit function, the surface."""

from shared.superquadric.implicit import inside_outside, radial_distance
from shared.superquadric.model import Superquadric
from shared.superquadric.surface import surface_mesh, surface_points, volume

__all__ = [
    "Superquadric",
    "inside_outside",
    "radial_distance",
    "surface_mesh",
    "surface_points",
    "volume",
]
