"""An object as closed meshes, one or more per named part."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STEEL, NYLON, WOOD, WATER = 7850.0, 1150.0, 700.0, 1000.0
ALUMINIUM, CERAMIC, GLASS, RUBBER = 2700.0, 2400.0, 2500.0, 1200.0
"""Densities in kg/m3."""


@dataclass(frozen=True)
class Mesh:
    """A triangle mesh; closed, unless it is a piece of a scan.

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
class Surface:
    """All triangles of an object in one mesh, each with the part that it belongs to.

    Attributes
    ----------
    vertices : (V, 3) array
        Metres, in the object's frame.
    faces : (F, 3) int32 array
        Rows of `vertices`.
    part : (F,) int16 array
        Index of the part of every triangle.
    """

    vertices: Array
    faces: NDArray[np.int32]
    part: NDArray[np.int16]


@dataclass(frozen=True)
class CatalogueObject:
    """An object, its parts, and which of them a gripper should hold for which task.

    The frame's origin and axes are the object's own; +z is up in use.

    Raises
    ------
    ValueError
        Two parts of one name, a region of an unknown part or of none, or a
        task that is afforded and not afforded at once.
    """

    name: str
    description: str
    parts: tuple[Part, ...]
    regions: Mapping[str, tuple[str, ...]]
    """Task -> names of the parts to hold; handover leaves the handle to the person."""
    class_name: str = ""
    """What kind of thing it is: pan, ladle, ...; empty if unknown."""
    not_afforded: tuple[str, ...] = ()
    """Tasks that the object clearly cannot serve. Doubtful ones are in neither list."""
    balance: tuple[float, float, float] | None = None
    """The centre of mass where it is known better than from the parts; metres."""

    def __post_init__(self) -> None:
        names = self.part_names
        if len(set(names)) < len(names):
            raise ValueError(f"{self.name}: two parts have the same name among {names}")
        for task, held in self.regions.items():
            unknown = sorted(set(held) - set(names))
            if unknown or not held:
                raise ValueError(f"{self.name}: no parts {unknown} for {task}; parts are {names}")
        both = sorted(set(self.regions) & set(self.not_afforded))
        if both:
            raise ValueError(f"{self.name}: {both} cannot be afforded and not afforded")

    @property
    def tasks(self) -> tuple[str, ...]:
        return tuple(self.regions)

    @property
    def part_names(self) -> tuple[str, ...]:
        return tuple(part.name for part in self.parts)

    @property
    def vertices(self) -> Array:
        """All vertices (V, 3) in metres."""
        return np.concatenate([mesh.vertices for part in self.parts for mesh in part.meshes])

    @property
    def surface(self) -> Surface:
        """All triangles, labelled by part; the inside of overlaps is included."""
        faces, labels, first = [], [], 0
        for index, part in enumerate(self.parts):
            for mesh in part.meshes:
                faces.append(mesh.faces + first)
                labels.append(np.full(len(mesh.faces), index, dtype=np.int16))
                first += len(mesh.vertices)
        return Surface(
            self.vertices, np.concatenate(faces).astype(np.int32), np.concatenate(labels)
        )

    @property
    def centre_of_mass(self) -> Array:
        """Return it (3,) in metres, in closed form: where meshes overlap, the overlap weighs twice.

        Good for placing an object. What tips over does so by
        `experiments.catalogue.mass.mass_properties`, which counts overlaps once.
        """
        if self.balance is not None:
            return np.array(self.balance)
        mass, first_moment = 0.0, np.zeros(3)
        for part in self.parts:
            for mesh in part.meshes:
                volume, centroid = mesh.moments()
                mass += part.density * volume
                first_moment += part.density * volume * centroid
        return np.asarray(first_moment / mass)
