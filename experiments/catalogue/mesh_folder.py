"""A folder of the user's own meshes, their parts given by a label file (docs/catalogue.md)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from experiments.catalogue.cutting import cut
from experiments.catalogue.mass import solid_properties
from experiments.catalogue.mesh_file import read_mesh
from experiments.catalogue.mesh_labels import MeshLabel, read_labels
from experiments.catalogue.model import WATER, CatalogueObject, Mesh, Part
from shared.errors import InvalidInput

__all__ = ["REST", "MeshLabel", "labelled_mesh", "read_labels", "read_mesh_folder"]

Array = NDArray[np.float64]

REST = "rest"
"""Name of the part that is in no task's region."""
SHEET_SHARE = 0.03
"""A surface that encloses less than this share of its hull is a sheet, not a solid."""


def read_mesh_folder(labels: Path, split: str | None = None) -> dict[str, CatalogueObject]:
    """Return the objects of a label file, by name, in its order.

    Parameters
    ----------
    labels : Path
        A JSON file: split -> name -> object (`MeshLabel`).
    split : str, optional
        Only this group of objects; otherwise all of them.

    Raises
    ------
    InvalidInput
        The file or a mesh is missing or cannot be read, there is no such split,
        a label is malformed, or a region holds no surface.
    """
    found: dict[str, CatalogueObject] = {}
    for name, label in read_labels(labels, split).items():
        found[name] = labelled_mesh(name, label, labels.parent)
    return found


def labelled_mesh(name: str, label: MeshLabel, folder: Path) -> CatalogueObject:
    """Return one object: its mesh, cut along the borders of its regions.

    Each part is what one set of tasks holds, named by them: `pouring`,
    `handover`, `handover+pouring` where regions overlap, `rest` outside them.

    Raises
    ------
    InvalidInput
        As `read_mesh_folder`.
    """
    vertices, faces = read_mesh(_mesh_path(label.file, folder))
    for axis, _, value in label.regions.values():
        vertices, faces = cut(vertices, faces, "xyz".index(axis), value)
    centroid = vertices[faces].mean(axis=1)
    inside = np.empty((len(faces), len(label.regions)), dtype=bool)
    for column, (task, (axis, side, value)) in enumerate(label.regions.items()):
        along = centroid[:, "xyz".index(axis)]
        inside[:, column] = along < value if side == "<" else along > value
        if not inside[:, column].any():
            raise InvalidInput(
                f"object {name!r}: the region for {task} is empty: {axis} {side} {value:g}, while "
                f"the mesh spans {axis} = {along.min():.4g} to {along.max():.4g}"
            )
    metric = label.scale * vertices
    parts: list[Part] = []
    regions: dict[str, tuple[str, ...]] = dict.fromkeys(label.regions, ())
    for pattern in np.unique(inside, axis=0)[::-1]:
        tasks = [task for task, held in zip(label.regions, pattern, strict=True) if held]
        part = "+".join(tasks) or REST
        used, corners = np.unique(faces[(inside == pattern).all(axis=1)], return_inverse=True)
        mesh = Mesh(metric[used], corners.reshape(-1, 3).astype(np.int32))
        parts.append(Part(part, (mesh,), WATER))
        for task in tasks:
            regions[task] = (*regions[task], part)
    try:
        return CatalogueObject(
            name=name,
            description=label.description,
            parts=tuple(parts),
            regions=regions,
            class_name=label.class_name,
            not_afforded=label.not_afforded,
            balance=_balance(name, Mesh(metric, faces.astype(np.int32))),
        )
    except ValueError as error:
        raise InvalidInput(str(error)) from None


def _mesh_path(file: str, folder: Path) -> Path:
    choices = [folder / file, folder / "meshes" / file]
    for path in choices:
        if path.is_file():
            return path
    raise InvalidInput(f"there is no mesh {choices[0]}, nor {choices[1]}")


def _balance(name: str, surface: Mesh) -> tuple[float, float, float]:
    """Return the centre of mass of what the surface encloses, or else of the surface as a sheet."""
    try:
        hull = ConvexHull(surface.vertices)
    except QhullError:
        raise InvalidInput(f"object {name!r} is flat: it has no volume to rest on") from None
    try:
        solid = solid_properties([surface], [1.0])
    except ValueError:
        solid = None
    if solid is not None and solid.mass > SHEET_SHARE * hull.volume:
        centre = solid.centre
        if bool((hull.equations[:, :3] @ centre + hull.equations[:, 3] < 0).all()):
            return float(centre[0]), float(centre[1]), float(centre[2])
    a, b, c = (surface.vertices[surface.faces[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    centre = (area[:, None] * (a + b + c) / 3).sum(axis=0) / area.sum()
    return float(centre[0]), float(centre[1]), float(centre[2])
