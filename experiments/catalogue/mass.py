"""Mass and balance of an object whose meshes overlap."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import open3d as o3d
from numpy.typing import NDArray

from experiments.catalogue.model import CatalogueObject, Mesh

Array = NDArray[np.float64]

LINES = 160
"""Per side of the grid of lines through an object."""


@dataclass(frozen=True)
class MassProperties:
    """What a scale and a knife edge would tell.

    Attributes
    ----------
    mass : float
        Kilograms.
    centre : (3,) array
        Metres, in the object's frame.
    """

    mass: float
    centre: Array


def mass_properties(thing: CatalogueObject) -> MassProperties:
    """Return mass and centre of mass, each place counted once.

    Where parts overlap, the densest one fills the place: a steel tang in a
    nylon handle. An object that knows its balance keeps it; it is one surface
    that was cut into parts, of the first part's density.

    Raises
    ------
    ValueError
        The object encloses nothing, and does not know its balance.
    """
    if thing.balance is not None:
        surface = thing.surface
        try:
            whole = [Mesh(surface.vertices, surface.faces)]
            mass = solid_properties(whole, [thing.parts[0].density]).mass
        except ValueError:
            mass = 0.0
        return MassProperties(mass, np.array(thing.balance))
    meshes = [mesh for part in thing.parts for mesh in part.meshes]
    return solid_properties(meshes, [part.density for part in thing.parts for _ in part.meshes])


def solid_properties(
    meshes: Sequence[Mesh], densities: Sequence[float], lines: int = LINES
) -> MassProperties:
    """Return mass and centre of the union of closed meshes.

    Parallel lines on a regular grid run through them along the axis in which
    they extend least. A line is inside a mesh from each crossing inwards to
    the next crossing outwards, so each segment between crossings has a density,
    and the segments are summed: exact along the lines, a midpoint rule across.

    Parameters
    ----------
    meshes : sequence of Mesh
        Closed ones; small holes cost what the few lines through them miss.
    densities : sequence of float
        One per mesh, kg/m3; the largest counts where meshes overlap.
    lines : int
        Per side of the grid.

    Raises
    ------
    ValueError
        The meshes enclose nothing.
    """
    vertices = np.concatenate([mesh.vertices for mesh in meshes])
    low, extent = vertices.min(axis=0), np.ptp(vertices, axis=0)
    along = int(extent.argmin())
    across = [axis for axis in range(3) if axis != along]
    scene = o3d.t.geometry.RaycastingScene()
    inward = []
    for mesh in meshes:
        corners = mesh.vertices[mesh.faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        inward.append(normals[:, along] < 0)
        scene.add_triangles(
            o3d.core.Tensor.from_numpy((mesh.vertices - low).astype(np.float32)),
            o3d.core.Tensor.from_numpy(mesh.faces.astype(np.uint32)),
        )
    start = _grid(extent, along, across, lines)
    direction = np.zeros(3)
    direction[along] = 1.0
    rays = np.hstack([start, np.broadcast_to(direction, start.shape)]).astype(np.float32)
    hit = scene.list_intersections(o3d.core.Tensor.from_numpy(rays))
    ray, mesh_id, face, reach = (
        hit[key].numpy() for key in ("ray_ids", "geometry_ids", "primitive_ids", "t_hit")
    )
    order = np.lexsort([reach, ray])
    ray, mesh_id, face = (each[order].astype(np.int64) for each in (ray, mesh_id, face))
    height = reach[order].astype(np.float64) + start[ray, along]
    first_face = np.cumsum([0, *(len(each) for each in inward)])
    step = np.where(np.concatenate(inward)[first_face[mesh_id] + face], 1, -1)
    density = _density(ray, mesh_id, step, np.asarray(densities, dtype=np.float64))
    length = np.diff(height, append=height[-1:]) * (np.diff(ray, append=-1) == 0)
    mass = density * length
    if not mass.sum() > 0:
        raise ValueError("the meshes enclose nothing")
    middle = start[ray]
    middle[:, along] = height + length / 2
    cell = float(np.prod(extent[across])) / lines**2
    return MassProperties(
        float(mass.sum()) * cell, low + (mass[:, None] * middle).sum(axis=0) / mass.sum()
    )


def _grid(extent: Array, along: int, across: list[int], lines: int) -> Array:
    """Return where the lines start (lines^2, 3), at the middle of their cells."""
    middle = (np.arange(lines) + 0.5) / lines
    one, other = np.meshgrid(*(extent[axis] * middle for axis in across), indexing="ij")
    start = np.empty((lines**2, 3))
    start[:, across] = np.column_stack([one.ravel(), other.ravel()])
    start[:, along] = -0.1 * extent[along] - 1e-3
    return start


def _density(
    ray: NDArray[np.int64], mesh_id: NDArray[np.int64], step: NDArray[np.int64], densities: Array
) -> Array:
    """Return the density (H,) between each crossing and the next one of its line."""
    density = np.zeros(len(ray))
    opens = np.flatnonzero(np.diff(ray, prepend=-1))
    for index, value in enumerate(densities):
        depth = np.cumsum(np.where(mesh_id == index, step, 0))
        before = np.where(opens > 0, depth[opens - 1], 0)
        depth = depth - np.repeat(before, np.diff(opens, append=len(ray)))
        density = np.where(depth > 0, np.maximum(density, value), density)
    return density
