"""From where the picture is seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from shared.geometry.rotation import frame_from_z, unit
from shared.schemas.primitive import Primitive

Array = NDArray[np.float64]

ELEVATION_DEG = 32.0
AZIMUTHS_DEG = (20.0, -20.0, 30.0, -30.0, 40.0, -40.0, 10.0, -10.0)
"""The picture is seen from the sensor's side, turned by one of these about the vertical."""


@dataclass(frozen=True)
class View:
    """From where the picture is seen.

    Attributes
    ----------
    axes : (3, 3) array
        Rows: to the right, upwards in the picture, towards the eye.
    ground : (3, 3) array
        Rows: away from the sensor, to its left, against gravity.
    centre : (3,) array
        Middle of the object.
    floor : float
        Height of the table above `centre`, metres (negative).
    """

    axes: Array
    ground: Array
    centre: Array
    floor: float

    @classmethod
    def of(
        cls,
        cloud: Array,
        primitives: Sequence[Primitive],
        fork: Array | None,
        up: ArrayLike,
        sensor: Array,
    ) -> View:
        """Return the view that shows most of the object and of the best gripper."""
        held = np.array([each.superquadric.position for each in primitives]).reshape(-1, 3)
        body = next((each for each in (cloud, held) if len(each)), np.zeros((1, 3)))
        centre = np.median(body, axis=0)
        z = unit(up) if np.linalg.norm(up) > 0 else np.array([0.0, 0.0, 1.0])
        ground = frame_from_z(z, x_hint=centre - sensor).T
        floor = float(np.percentile((body - centre) @ z, 0.5))
        views = [cls(_axes(ground, azimuth), ground, centre, floor) for azimuth in AZIMUTHS_DEG]
        return max(views, key=lambda view: view.shows(body, fork))

    def shows(self, body: Array, fork: Array | None) -> float:
        """Return how well the object and the best gripper's opening are seen from here."""
        length = float(np.linalg.norm(self.flat(body - np.median(body, axis=0) + self.centre), 2))
        if fork is None:
            return length
        side = unit(np.cross(fork[1] - fork[0], fork[2] - fork[1]))
        return length * (0.5 + min(abs(float(side @ self.axes[2])), 0.5))

    def flat(self, points: Array) -> Array:
        """Return where points (..., 3) are in the picture (..., 2), metres."""
        return np.asarray((points - self.centre) @ self.axes[:2].T)

    def nearness(self, points: Array) -> Array:
        """Return how far points (..., 3) are towards the eye, metres."""
        return np.asarray((points - self.centre) @ self.axes[2])

    def dropped(self, points: Array) -> Array:
        """Return points (..., 3) moved straight down to the table."""
        up = self.ground[2]
        height = (points - self.centre) @ up - self.floor
        return np.asarray(points - height[..., None] * up)

    def table(self, cloud: Array) -> Array:
        """Return the corners (4, 3) of a piece of table under the cloud, along its length."""
        there = (cloud - self.centre) @ self.ground[:2].T if len(cloud) else np.zeros((1, 2))
        centred = there - there.mean(axis=0)
        turn = np.linalg.eigh(centred.T @ centred)[1]
        low, high = (there @ turn).min(axis=0) - 0.03, (there @ turn).max(axis=0) + 0.03
        rim = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
        flat = np.array(rim) @ turn.T
        return np.asarray(
            self.centre + np.column_stack([flat, np.full(4, self.floor)]) @ self.ground
        )

    def limits(self, things: Sequence[Array]) -> tuple[Array, Array]:
        """Return the lowest and highest corner (2,) in the picture of all these points."""
        everything = np.concatenate([self.flat(self.table(things[0])), *map(self.flat, things)])
        everything = everything[np.isfinite(everything).all(axis=1)]
        return everything.min(axis=0) - 0.006, everything.max(axis=0) + 0.006


def _axes(ground: Array, azimuth_deg: float) -> Array:
    """Return the picture's axes for an eye turned by the azimuth from the sensor's side."""
    azimuth, elevation = np.radians([azimuth_deg, ELEVATION_DEG])
    behind = -np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    eye = np.cos(elevation) * behind + np.sin(elevation) * np.array([0.0, 0.0, 1.0])
    right = unit(np.cross([0.0, 0.0, 1.0], eye))
    return np.array([right, np.cross(eye, right), eye]) @ ground


def shading(cloud: Array, view: View, sensor: Array) -> Array:
    """Return the brightness (N,) of each point, from the normal of its neighbourhood."""
    if len(cloud) < 16:
        return np.ones(len(cloud))
    _, neighbours = cKDTree(cloud).query(cloud, k=16)
    around = cloud[neighbours] - cloud[neighbours].mean(axis=1, keepdims=True)
    normals = np.linalg.eigh(np.swapaxes(around, 1, 2) @ around)[1][:, :, 0]
    normals *= np.sign(np.einsum("ij,ij->i", normals, sensor - cloud))[:, None]
    lamp = unit([-0.5, 0.75, 0.45]) @ view.axes
    return np.asarray(0.68 + 0.42 * np.clip(normals @ lamp, -0.6, 1.0))
