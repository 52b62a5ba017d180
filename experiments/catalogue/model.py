"""An object as closed meshes, one or more per named part."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STEEL, NYLON, WOOD, WATER = 7850.0, 1150.0, 700.0, 1000.0
"""Densities in kg/m3."""


@dataclass(frozen=True)
class Mesh:
    """A closed triangle mesh.

    Attributes
    ----------
    vertices : (V, 3) array
        Metres, in the object's frame.
    faces : (F, 3) int32 array
        Rows of `vertices`, counter-clockwise from outside.
    """

    vertices: Array
    faces: NDArray[np.int32]

    def moments(self) -> tuple[float, Array]:
        """Return the enclosed volume in cubic metres and its centroid (3,)."""
        a, b, c = (self.vertices[self.faces[:, k]] for k in range(3))
        volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
        volume = float(volumes.sum())
        return volume, (volumes[:, None] * (a + b + c) / 4).sum(axis=0) / volume


@dataclass(frozen=True)
class Part:
    """A named part; its meshes may overlap each other and those of other parts."""

    name: str
    meshes: tuple[Mesh, ...]
    density: float = WATER
    """In kg/m3: it decides how the object comes to rest."""


@dataclass(frozen=True)
class CatalogueObject:
    """An object, its parts, and which of them a gripper should hold for which task.

    The frame's origin and axes are the object's own; +z is up in use.
    """

    name: str
    description: str
    parts: tuple[Part, ...]
    regions: Mapping[str, tuple[str, ...]]
    """Task -> names of the parts to hold; handover leaves the handle to the person."""

    @property
    def tasks(self) -> tuple[str, ...]:
        return tuple(self.regions)

    @property
    def vertices(self) -> Array:
        """All vertices (V, 3) in metres."""
        return np.concatenate([mesh.vertices for part in self.parts for mesh in part.meshes])

    @property
    def centre_of_mass(self) -> Array:
        """Return it (3,) in metres; where meshes overlap, the overlap weighs twice."""
        mass, first_moment = 0.0, np.zeros(3)
        for part in self.parts:
            for mesh in part.meshes:
                volume, centroid = mesh.moments()
                mass += part.density * volume
                first_moment += part.density * volume * centroid
        return np.asarray(first_moment / mass)
