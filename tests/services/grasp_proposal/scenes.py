"""Objects on a table as a head camera sees them: only the side that faces it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from shared.geometry.rotation import matrix_from_quaternion
from shared.geometry.se3 import transform_points
from shared.schemas.grasp import ProposeRequest
from shared.schemas.scene import SupportPlane

Array = NDArray[np.float64]

TABLE = 0.0
SENSOR = np.array([-0.6, 0.0, 0.6])
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Scene:
    """Visible points and normals above the table z = 0, seen from `sensor`."""

    points: Array
    normals: Array
    sensor: Array
    up: Array
    offset: float = TABLE

    def request(self, **changes: object) -> ProposeRequest:
        """Return the request for grasps in this scene."""
        fields: dict[str, object] = {
            "points": self.points,
            "viewpoint": tuple(self.sensor.tolist()),
            "up": tuple(self.up.tolist()),
            "plane": SupportPlane(
                normal=tuple(self.up.tolist()), offset=self.offset, inliers=1000, residual_mm=0.5
            ),
            "samples": 120,
        }
        return ProposeRequest.model_validate(fields | changes)

    def moved(self, motion: Array) -> Scene:
        """Return the scene in another frame."""
        up = motion[:3, :3] @ self.up
        return replace(
            self,
            points=transform_points(motion, self.points),
            normals=self.normals @ motion[:3, :3].T,
            sensor=transform_points(motion, self.sensor[None])[0],
            up=up,
            offset=self.offset - float(up @ motion[:3, 3]),
        )


def seen(points: Array, normals: Array, sensor: Array = SENSOR) -> Scene:
    """Keep what faces the sensor."""
    facing = ((sensor - points) * normals).sum(axis=1) > 0
    return Scene(points[facing], normals[facing], sensor, UP)


def lying_cylinder(radius: float = 0.02, length: float = 0.16, turn: float = 0.5) -> Scene:
    """A bar of round section on the table, its axis turned by `turn` from y."""
    along, around = np.meshgrid(
        np.arange(-length / 2, length / 2, 0.002), np.arange(0, 2 * np.pi, 0.002 / radius)
    )
    angle = around.ravel()
    normals = np.column_stack([np.cos(angle), np.zeros_like(angle), np.sin(angle)])
    points = normals * radius + np.column_stack(
        [np.zeros_like(angle), along.ravel(), np.full_like(angle, radius)]
    )
    rotation = about_z(turn)
    return seen(points @ rotation.T, normals @ rotation.T)


def box(size: tuple[float, float, float], turn: float = 0.3, step: float = 0.002) -> Scene:
    """A box of this size on the table."""
    half = np.array(size) / 2
    points, normals = [], []
    for axis in range(3):
        u, v = (a for a in range(3) if a != axis)
        grid = np.meshgrid(np.arange(-half[u], half[u], step), np.arange(-half[v], half[v], step))
        for sign in (-1.0, 1.0):
            face = np.zeros((grid[0].size, 3))
            face[:, u], face[:, v], face[:, axis] = (
                grid[0].ravel(),
                grid[1].ravel(),
                sign * half[axis],
            )
            points.append(face)
            normals.append(np.tile(sign * np.eye(3)[axis], (len(face), 1)))
    rotation = about_z(turn)
    surface = np.vstack(points) @ rotation.T + [0, 0, half[2]]
    return seen(surface, np.vstack(normals) @ rotation.T)


def about_z(angle: float) -> Array:
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])


def rotations_of(grasps: Array) -> Array:
    """Return rotation matrices (G, 3, 3) of grasp rows (G, 9)."""
    return matrix_from_quaternion(grasps[:, 3:7])


PAN = {"radius": 0.1, "wall": 0.006, "height": 0.06, "floor": 0.03}
"""Of `pan`, metres: `radius` is the inner one, the floor's height is over the table."""


def pan(step: float = 0.002) -> Scene:
    """A pan without a handle, of which the sensor sees what the wall lets it."""
    radius, wall, height, floor = PAN.values()
    turn = np.arange(0, 2 * np.pi, step / radius)
    out = np.column_stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)])

    def ring(radii: Array, heights: Array) -> Array:
        return np.vstack([r * out + z * UP for r, z in zip(radii, heights, strict=True)])

    outside, inside, across = (
        np.arange(low, high, step) for low, high in ((0, height), (floor, height), (0, wall))
    )
    x, y = (axis.ravel() for axis in np.meshgrid(*[np.arange(-radius, radius, step)] * 2))
    disc = np.column_stack([x, y, np.full_like(x, floor)])[np.hypot(x, y) < radius]
    scene = seen(
        np.vstack(
            [
                ring(np.full_like(outside, radius + wall), outside),
                ring(np.full_like(inside, radius), inside),
                ring(radius + across, np.full_like(across, height)),
                disc,
            ]
        ),
        np.vstack(
            [
                np.tile(out, (len(outside), 1)),
                np.tile(-out, (len(inside), 1)),
                np.tile(UP, (len(out) * len(across) + len(disc), 1)),
            ]
        ),
    )
    shown = ~behind_the_wall(scene.points)
    return replace(scene, points=scene.points[shown], normals=scene.normals[shown])


def behind_the_wall(points: Array) -> NDArray[np.bool_]:
    """Say which points (N, 3) in or at the `pan` the near wall of its inside hides."""
    ray = SENSOR - points
    a = (ray[:, :2] ** 2).sum(axis=1)
    b = 2 * (points[:, :2] * ray[:, :2]).sum(axis=1)
    c = (points[:, :2] ** 2).sum(axis=1) - PAN["radius"] ** 2
    leaves = (-b + np.sqrt(np.maximum(b**2 - 4 * a * c, 0.0))) / (2 * a)
    within = np.hypot(points[:, 0], points[:, 1]) < PAN["radius"] + 1e-9
    over = points[:, 2] + leaves * ray[:, 2]
    return np.asarray(within & (leaves > 0.01) & (over < PAN["height"]))
