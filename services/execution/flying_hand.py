"""A parallel gripper without an arm: boxes for palm and fingers, led through space by a joint."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pybullet
from numpy.typing import NDArray

from services.execution.bullet import Bullet
from shared.geometry.rotation import quaternion_from_matrix
from shared.geometry.se3 import matrix_from_pose
from shared.schemas.gripper import ParallelGripper

Array = NDArray[np.float64]

PALM, LEFT, RIGHT = -1, 0, 1
FINGERS = (LEFT, RIGHT)
LINK_NAMES = {PALM: "the palm", LEFT: "the left finger", RIGHT: "the right finger"}
PALM_MASS, FINGER_MASS = 1.0, 0.1
PAD_FRICTION = 1.0
PAD_SPINNING_FRICTION = 0.003
"""Metres: what a pad of a finger's width resists in torsion is small, so a long bar hangs."""
FINGER_SPEED = 0.25
"""Metres a second of each finger."""
LEADING_FORCE = 400.0
"""Newtons that move the hand at most: as much as lets a stuck hand stop, not the world burst."""
GEAR_STRENGTH = 2.5
"""Force of the gear between the fingers, in grip forces: they move as one."""


class FlyingHand:
    """A parallel gripper whose palm is held at a pose in the world.

    Parameters
    ----------
    bullet : Bullet
    gripper : ParallelGripper
    world_from_grasp : (4, 4) array
        Where it appears.
    opening : float
        Between the pads, metres.
    """

    def __init__(
        self, bullet: Bullet, gripper: ParallelGripper, world_from_grasp: Array, opening: float
    ) -> None:
        self._bullet = bullet
        self.gripper = gripper
        self.body = self._add(world_from_grasp)
        for finger in FINGERS:
            bullet.changeDynamics(
                self.body,
                finger,
                lateralFriction=PAD_FRICTION,
                spinningFriction=PAD_SPINNING_FRICTION,
                jointLowerLimit=0.0,
                jointUpperLimit=gripper.max_opening / 2,
            )
            bullet.resetJointState(self.body, finger, opening / 2)
        gear = bullet.createConstraint(
            self.body,
            LEFT,
            self.body,
            RIGHT,
            pybullet.JOINT_GEAR,
            [1, 0, 0],
            [0, 0, 0],
            [0, 0, 0],
        )
        bullet.changeConstraint(gear, gearRatio=-1, erp=0.1, maxForce=GEAR_STRENGTH * gripper.force)
        position, quaternion = pose_lists(world_from_grasp)
        self._lead: int = bullet.createConstraint(
            self.body,
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
        self.drive_fingers(opening, 3 * gripper.force)

    def lead(self, position: Sequence[float], quaternion: Sequence[float]) -> None:
        """Set where the grasp frame is led to from the next step on."""
        self._bullet.changeConstraint(self._lead, position, quaternion, maxForce=LEADING_FORCE)

    def drive_fingers(self, opening: float, force: float) -> None:
        """Set the finger motors' goal (metres between the pads) and force (newtons each)."""
        for finger in FINGERS:
            self._bullet.setJointMotorControl2(
                self.body,
                finger,
                pybullet.POSITION_CONTROL,
                targetPosition=opening / 2,
                force=force,
                maxVelocity=FINGER_SPEED,
            )

    @property
    def opening(self) -> float:
        """Distance between the pads, metres."""
        return float(sum(s[0] for s in self._bullet.getJointStates(self.body, FINGERS)))

    @property
    def world_from_grasp(self) -> Array:
        """Where the grasp frame is now, (4, 4)."""
        return matrix_from_pose(*self._bullet.getBasePositionAndOrientation(self.body))

    def touching(self, other: int) -> set[int]:
        """Return the links that touch body `other`."""
        return {
            contact[3] for contact in self._bullet.getContactPoints(bodyA=self.body, bodyB=other)
        }

    def force_on(self, other: int, link: int) -> float:
        """Return the normal force of a link on body `other`, newtons."""
        contacts = self._bullet.getContactPoints(bodyA=self.body, bodyB=other, linkIndexA=link)
        return float(sum(contact[9] for contact in contacts))

    def _add(self, world_from_grasp: Array) -> int:
        """Add palm and fingers; the body's frame is the grasp frame."""
        gripper, bullet = self.gripper, self._bullet
        root = gripper.tip_beyond_tcp - gripper.finger_length
        palm = bullet.createCollisionShape(
            pybullet.GEOM_BOX,
            halfExtents=[side / 2 for side in gripper.palm_size],
            collisionFramePosition=[0, 0, root - gripper.palm_size[2] / 2],
        )
        finger = bullet.createCollisionShape(
            pybullet.GEOM_BOX,
            halfExtents=[
                gripper.finger_width / 2,
                gripper.finger_thickness / 2,
                gripper.finger_length / 2,
            ],
        )
        middle = root + gripper.finger_length / 2
        position, quaternion = pose_lists(world_from_grasp)
        body: int = bullet.createMultiBody(
            PALM_MASS,
            palm,
            basePosition=position,
            baseOrientation=quaternion,
            linkMasses=[FINGER_MASS] * 2,
            linkCollisionShapeIndices=[finger] * 2,
            linkVisualShapeIndices=[-1] * 2,
            linkPositions=[[0, side * gripper.finger_thickness / 2, middle] for side in (1, -1)],
            linkOrientations=[[0, 0, 0, 1]] * 2,
            linkInertialFramePositions=[[0, 0, 0]] * 2,
            linkInertialFrameOrientations=[[0, 0, 0, 1]] * 2,
            linkParentIndices=[0, 0],
            linkJointTypes=[pybullet.JOINT_PRISMATIC] * 2,
            linkJointAxis=[[0, 1, 0], [0, -1, 0]],
        )
        return body


def pose_lists(pose: Array) -> tuple[list[float], list[float]]:
    """Return position and quaternion of a pose (4, 4) as the simulator takes them."""
    return pose[:3, 3].tolist(), quaternion_from_matrix(pose[:3, :3]).tolist()
