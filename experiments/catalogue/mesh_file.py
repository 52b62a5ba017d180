"""The triangles of a mesh file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import open3d as o3d
from numpy.typing import NDArray

from experiments.catalogue.collada import read_collada
from shared.errors import InvalidInput

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

READABLE = (".dae", ".obj", ".ply", ".stl")


def read_mesh(path: Path) -> tuple[Array, Indices]:
    """Return the triangles of a mesh: vertices (V, 3) in its own units and faces (F, 3).

    Vertices at the same place are one. A surface that is inside out is turned.

    Raises
    ------
    InvalidInput
        The file is missing, of an unknown kind, cannot be read, or has no triangles.
    """
    if path.suffix.lower() not in READABLE:
        raise InvalidInput(f"{path} is not a mesh that can be read; {', '.join(READABLE)} can")
    if not path.is_file():
        raise InvalidInput(f"there is no mesh {path}")
    if path.suffix.lower() == ".dae":
        vertices, faces = read_collada(path)
    else:
        with o3d.utility.VerbosityContextManager(o3d.utility.VerbosityLevel.Error):
            mesh = o3d.io.read_triangle_mesh(path)
        vertices = np.asarray(mesh.vertices, dtype=np.float64)
        faces = np.asarray(mesh.triangles, dtype=np.int64)
    if len(faces) == 0:
        raise InvalidInput(f"{path} has no triangles, or cannot be read")
    if not np.isfinite(vertices).all():
        raise InvalidInput(f"{path} has vertices that are not finite")
    vertices, where = np.unique(vertices, axis=0, return_inverse=True)
    faces = where.reshape(-1)[faces]
    distinct = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    faces = faces[distinct]
    if len(faces) == 0:
        raise InvalidInput(f"{path} has no triangles of any size")
    a, b, c = (vertices[faces[:, k]] - vertices.mean(axis=0) for k in range(3))
    if np.einsum("ij,ij->i", a, np.cross(b, c)).sum() < 0:
        faces = faces[:, ::-1]
    return vertices, faces
