"""Convex polyhedra: hull, volume, moments, and what remains above a plane."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from shared.geometry.rotation import unit

Array = NDArray[np.float64]

MIN_VOLUME = 1e-9
"""A cubic millimetre, in cubic metres; less is taken for flat."""


@dataclass(frozen=True)
class ConvexPart:
    """A convex polyhedron.

    Attributes
    ----------
    vertices : (V, 3) array
        Corners of the hull, metres.
    faces : (F, 3) int32 array
        Triangles, counter-clockwise from outside.
    """

    vertices: Array
    faces: NDArray[np.int32]

    @property
    def planes(self) -> tuple[Array, Array]:
        """Outward unit normals (F, 3) and offsets (F,) of the faces: inside, n . p <= offset."""
        corners = self.vertices[self.faces]
        normals = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
        return normals, np.einsum("fi,fi->f", normals, corners[:, 0])

    def moments(self) -> tuple[float, Array, Array]:
        """Return volume, centroid (3,) and the second moment (3, 3) about the origin.

        The second moment is the integral of x x^T over the solid, in m^5, summed
        over the tetrahedra that the triangles span with the origin.
        """
        corners = self.vertices[self.faces]
        signed = np.linalg.det(corners) / 6
        volume = float(signed.sum())
        total = corners.sum(axis=1)
        centroid = signed @ total / 4 / volume
        second = np.einsum("f,fki,fkj->ij", signed, corners, corners)
        second += np.einsum("f,fi,fj->ij", signed, total, total)
        return volume, centroid, second / 20

    def moved(self, motion: Array) -> ConvexPart:
        """Return this part moved by a rigid motion (4, 4)."""
        return ConvexPart(self.vertices @ motion[:3, :3].T + motion[:3, 3], self.faces)

    def above(self, height: float) -> ConvexPart | None:
        """Return what lies above z = `height`, or None when nothing solid does."""
        z = self.vertices[:, 2] - height
        if (z >= 0).all():
            return self
        start, end = np.unique(np.sort(self._edges(), axis=1), axis=0).T
        crossing = z[start] * z[end] < 0
        start, end = start[crossing], end[crossing]
        share = (z[start] / (z[start] - z[end]))[:, None]
        cut = self.vertices[start] + share * (self.vertices[end] - self.vertices[start])
        return convex_hull(np.vstack([self.vertices[z >= 0], cut]))

    def _edges(self) -> NDArray[np.int32]:
        return self.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)


def convex_hull(points: Array) -> ConvexPart | None:
    """Return the convex hull of points (N, 3), or None when they span no volume."""
    hull = _qhull(points)
    if hull is None:
        return None
    renumbered = np.full(len(points), -1, dtype=np.int32)
    renumbered[hull.vertices] = np.arange(len(hull.vertices), dtype=np.int32)
    faces = hull.simplices
    corners = hull.points[faces]
    turn = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = np.einsum("fi,fi->f", turn, hull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    return ConvexPart(points[hull.vertices], renumbered[faces])


def hull_volume(points: Array) -> float:
    """Return the volume of the convex hull of points (N, 3), 0 when they span none."""
    hull = _qhull(points)
    return 0.0 if hull is None else float(hull.volume)


def _qhull(points: Array) -> ConvexHull | None:
    """Return the hull of points (N, 3) about their mean, or None when they span no volume."""
    if len(points) < 4:
        return None
    try:
        hull = ConvexHull(points - points.mean(axis=0))
    except QhullError:
        return None
    return hull if hull.volume >= MIN_VOLUME else None


def write_obj(path: Path, meshes: Iterable[tuple[Array, NDArray[np.int32]]]) -> None:
    """Write meshes, vertices (V, 3) and triangles (F, 3), as groups of a Wavefront OBJ file."""
    lines, before = [], 1
    for index, (vertices, faces) in enumerate(meshes):
        lines.append(f"o part{index}")
        lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in vertices.tolist()]
        lines += [f"f {a} {b} {c}" for a, b, c in (faces + before).tolist()]
        before += len(vertices)
    path.write_text("\n".join(lines) + "\n")
