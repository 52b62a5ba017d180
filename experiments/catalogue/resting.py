"""How an object comes to rest on a table: on the facets of its convex hull."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import ConvexHull

from experiments.catalogue.mass import mass_properties
from experiments.catalogue.model import CatalogueObject
from shared.geometry.rotation import frame_from_z, unit

Array = NDArray[np.float64]

SAME_FACET_DEG = 0.5


@dataclass(frozen=True)
class RestingPose:
    """A stable orientation.

    Attributes
    ----------
    up : tuple of float
        The direction in the object's frame that points up.
    probability : float
        Share of the sphere of directions that the facet takes, seen from the
        centre of mass, among all stable ones: how likely the object is to end
        on it when dropped at random (an estimate without dynamics).
    """

    up: tuple[float, float, float]
    probability: float

    @property
    def table_from_object(self) -> Array:
        """Rotation (3, 3) that turns `up` to +z."""
        return frame_from_z(self.up).T


def resting_poses(thing: CatalogueObject) -> tuple[RestingPose, ...]:
    """Return the stable orientations, most probable first.

    A facet of the convex hull is stable when the centre of mass projects into it.
    """
    centre = mass_properties(thing).centre
    hull = ConvexHull(thing.vertices)
    corners = hull.points[hull.simplices] - centre
    normals, depths = (
        hull.equations[:, :3],
        -(hull.equations[:, :3] @ centre) - hull.equations[:, 3],
    )
    feet = normals * depths[:, None]  # the centre of mass, projected onto each facet
    held = _contains(corners, feet, normals)
    solid_angle = _solid_angle(corners)
    found: list[tuple[Array, float]] = []
    left = np.ones(len(normals), dtype=bool)
    for index in np.argsort(-solid_angle, kind="stable"):
        if not left[index]:
            continue
        facet = left & (normals @ normals[index] > np.cos(np.radians(SAME_FACET_DEG)))
        left &= ~facet
        if held[facet].any():
            found.append((-normals[index], float(solid_angle[facet].sum())))
    total = sum(share for _, share in found)
    found.sort(key=lambda each: (-round(each[1], 9), tuple(each[0])))
    return tuple(
        RestingPose((float(up[0]), float(up[1]), float(up[2])), share / total)
        for up, share in found
    )


def resting_pose(thing: CatalogueObject, up: ArrayLike) -> RestingPose:
    """Return the stable orientation whose upward direction is nearest to `up` (3,).

    Of equally near ones (a bottle's side has many), the first in the order of
    their coordinates.
    """
    wanted = unit(up)
    return min(
        resting_poses(thing), key=lambda pose: (-round(float(np.dot(pose.up, wanted)), 9), pose.up)
    )


def _contains(corners: Array, points: Array, normals: Array) -> NDArray[np.bool_]:
    """Return (F,) whether each triangle of corners (F, 3, 3) holds its point of its plane."""
    sides = []
    for k in range(3):
        a, b = corners[:, k], corners[:, (k + 1) % 3]
        sides.append(_dot(np.cross(b - a, points - a), normals))
    signs = np.array(sides)
    slack = 1e-12
    return np.asarray((signs >= -slack).all(axis=0) | (signs <= slack).all(axis=0))


def _solid_angle(corners: Array) -> Array:
    """Return the solid angle (F,) of triangles (F, 3, 3) seen from the origin.

    Van Oosterom and Strackee, 1983.
    """
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    la, lb, lc = (np.linalg.norm(each, axis=1) for each in (a, b, c))
    triple = np.abs(_dot(a, np.cross(b, c)))
    below = la * lb * lc + _dot(a, b) * lc + _dot(a, c) * lb + _dot(b, c) * la
    return np.asarray(2 * np.arctan2(triple, below))


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("ij,ij->i", a, b))
