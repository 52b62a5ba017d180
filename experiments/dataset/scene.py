"""Where an object lies in a view: dropped on a table, fully in the head camera's image."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from experiments.camera import D435, HeadCamera, PinholeCamera, Table, place_on
from experiments.dataset.drop import Body
from shared.errors import InvalidInput
from shared.geometry.se3 import inverse, transform_points

Array = NDArray[np.float64]

TABLE_HEIGHTS = (0.8, 1.0)
"""Metres; views take them in turn."""

HEAD_HEIGHT = 1.4
"""Metres: the head camera of a robot like TIAGo, torso raised. It looks at the table's middle."""

PLACE_X, PLACE_Y = (0.55, 0.90), (-0.25, 0.25)
"""Where an object's centre of mass may lie, metres from the robot: within its arm's reach."""

IMAGE_MARGIN_PX, TABLE_MARGIN = 6.0, 0.01
"""An object keeps this far from the image's and the table's borders."""

TRIES_PER_POSE, POSES = 100, 20


@dataclass(frozen=True)
class Scene:
    """An object at rest on a table before the camera; poses are (4, 4)."""

    table: Table
    world_from_object: Array
    world_from_camera: Array

    @property
    def camera_from_object(self) -> Array:
        return inverse(self.world_from_camera) @ self.world_from_object

    @property
    def camera_from_world(self) -> Array:
        return inverse(self.world_from_camera)


def draw_scene(
    body: Body, number: int, rng: np.random.Generator, camera: PinholeCamera = D435
) -> Scene:
    """Return the scene of view `number`: even ones on the lower table, odd ones on the higher.

    The resting pose is drawn by its probability, then yaw and position until
    the whole object is on the table and in the image.

    Raises
    ------
    InvalidInput
        The object does not fit into the image or onto the table.
    """
    table = Table(height=TABLE_HEIGHTS[number % len(TABLE_HEIGHTS)])
    head = HeadCamera(HEAD_HEIGHT, (table.near + table.depth / 2, 0.0, table.height))
    world_from_camera = head.world_from_camera
    camera_from_world = inverse(world_from_camera)
    probability = np.array([pose.probability for pose in body.poses])
    for _ in range(POSES):
        pose = body.poses[int(rng.choice(len(probability), p=probability))]
        upright = place_on(table, body.thing, pose, position=(0.0, 0.0), yaw_deg=0.0)
        for _ in range(TRIES_PER_POSE):
            moved = _turn_and_shift(
                rng.uniform(0, 2 * np.pi), rng.uniform(*PLACE_X), rng.uniform(*PLACE_Y)
            )
            world_from_object = moved @ upright
            hull = transform_points(world_from_object, body.hull)
            seen = in_image(transform_points(camera_from_world, hull), camera, IMAGE_MARGIN_PX)
            if seen and on_table(hull, table):
                return Scene(table, world_from_object, world_from_camera)
    size = np.ptp(body.hull, axis=0)
    raise InvalidInput(
        f"object {body.thing.name!r} does not fit into the view: it measures "
        f"{size[0]:.3f} x {size[1]:.3f} x {size[2]:.3f} m (are its units metres?)"
    )


def in_image(points: Array, camera: PinholeCamera, margin_px: float = 0.0) -> bool:
    """Return whether all points (N, 3) of the camera's frame are seen, `margin_px` inside."""
    if not bool((points[:, 2] > 0).all()):
        return False
    pixels = points @ camera.intrinsics.T
    pixels = pixels[:, :2] / pixels[:, 2:]
    highest = np.array([camera.width, camera.height]) - 1 - margin_px
    return bool((pixels >= margin_px).all() and (pixels <= highest).all())


def on_table(points: Array, table: Table) -> bool:
    """Return whether all points (N, 3) of the world's frame are over the table, off its borders."""
    low, high = (corner[:2] for corner in table.corners)
    inside = (points[:, :2] >= low + TABLE_MARGIN) & (points[:, :2] <= high - TABLE_MARGIN)
    return bool(inside.all())


def _turn_and_shift(yaw: float, x: float, y: float) -> Array:
    """Return the motion (4, 4) that turns about the vertical and shifts along the ground."""
    motion = np.eye(4)
    motion[:2, :2] = [[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]]
    motion[:2, 3] = x, y
    return motion
