"""A gripper without an arm: a body that a joint leads through space."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pybullet
from numpy.typing import NDArray

from services.execution.bullet import Bullet
from shared.geometry.rotation import quaternion_from_matrix
from shared.geometry.se3 import matrix_from_pose

Array = NDArray[np.float64]

PALM = -1
PALM_MASS = 1.0
LEADING_FORCE = 400.0
"""Newtons that move the hand at most: as much as lets a stuck hand stop, not the world burst."""


class Flying:
    """A body whose frame is the grasp frame, led by a joint to the world.

    Parameters
    ----------
    bullet : Bullet
    body : int
        Its number in the simulator.
    world_from_grasp : (4, 4) array
        Where it is.
    """

    def __init__(self, bullet: Bullet, body: int, world_from_grasp: Array) -> None:
        self._bullet = bullet
        self.body = body
        position, quaternion = pose_lists(world_from_grasp)
        self._lead: int = bullet.createConstraint(
            body,
            PALM,
            -1,
            -1,
            pybullet.JOINT_FIXED,
            [0, 0, 0],
            [0, 0, 0],
            position,
            childFrameOrientation=quaternion,
        )
        self.lead(position, quaternion)

    def lead(self, position: Sequence[float], quaternion: Sequence[float]) -> None:
        """Set where the grasp frame is led to from the next step on."""
        self._bullet.changeConstraint(self._lead, position, quaternion, maxForce=LEADING_FORCE)

    @property
    def world_from_grasp(self) -> Array:
        """Where the grasp frame is now, (4, 4)."""
        return matrix_from_pose(*self._bullet.getBasePositionAndOrientation(self.body))

    def force_on(self, other: int, link: int = PALM) -> float:
        """Return the normal force of a link on body `other`, newtons."""
        contacts = self._bullet.getContactPoints(bodyA=self.body, bodyB=other, linkIndexA=link)
        return float(sum(contact[9] for contact in contacts))


def pose_lists(pose: Array) -> tuple[list[float], list[float]]:
    """Return position and quaternion of a pose (4, 4) as the simulator takes them."""
    return pose[:3, 3].tolist(), quaternion_from_matrix(pose[:3, :3]).tolist()
