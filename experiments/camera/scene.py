"""Where things stand: the world's z is up, the robot at its origin faces +x."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from experiments.camera.pinhole import look_at
from experiments.catalogue import CatalogueObject, RestingPose
from shared.geometry.se3 import pose_matrix

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Table:
    """A rectangular table top in front of the robot, metres."""

    height: float = 0.8
    near: float = 0.35
    """Distance of its near edge from the robot."""
    depth: float = 0.65
    width: float = 1.2
    thickness: float = 0.03

    @property
    def corners(self) -> tuple[Array, Array]:
        """Lowest and highest corner (3,) in the world's frame."""
        low = np.array([self.near, -self.width / 2, self.height - self.thickness])
        return low, low + np.array([self.depth, self.width, self.thickness])


@dataclass(frozen=True)
class HeadCamera:
    """The camera in the robot's head, metres."""

    height: float = 1.3
    looks_at: tuple[float, float, float] = (0.65, 0.0, 0.8)

    @property
    def world_from_camera(self) -> Array:
        """Its pose (4, 4)."""
        return look_at((0.0, 0.0, self.height), self.looks_at)


def place_on(
    table: Table,
    thing: CatalogueObject,
    pose: RestingPose,
    *,
    position: tuple[float, float],
    yaw_deg: float,
) -> Array:
    """Return world_from_object (4, 4) of an object at rest on the table.

    Its centre of mass is above `position` (x, y) in metres; `yaw_deg` turns it
    about the vertical; its lowest point touches the table.
    """
    yaw = np.radians(yaw_deg)
    turn = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    rotation = turn @ pose.table_from_object
    centre = rotation @ thing.centre_of_mass
    lowest = float((thing.vertices @ rotation[2]).min())
    offset = (position[0] - centre[0], position[1] - centre[1], table.height - lowest)
    return pose_matrix(offset, rotation)
