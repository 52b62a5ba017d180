"""The Panda arm and hand of pybullet_data: kinematics, motion, what it touches."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pybullet
import pybullet_data
from numpy.typing import NDArray

from services.execution.bullet import Bullet
from shared.geometry.rotation import quaternion_from_matrix
from shared.geometry.se3 import inverse, matrix_from_pose, pose_matrix

Array = NDArray[np.float64]

MODEL = Path(pybullet_data.getDataPath(), "franka_panda", "panda.urdf")
JOINTS = tuple(range(7))
HAND, LEFT_FINGER, RIGHT_FINGER = 8, 9, 10
FINGERS = (LEFT_FINGER, RIGHT_FINGER)
HAND_FROM_GRASP = pose_matrix([0.0, 0.0, 0.1034], np.eye(3))
"""The tool centre point `panda_hand_tcp`, in the frame of link `panda_hand`."""
MAX_OPENING = 0.08
HOME = np.array([0.0, -np.pi / 4, 0.0, -3 * np.pi / 4, 0.0, np.pi / 2, np.pi / 4])
"""The ready pose of the real robot: hand in front, pointing down."""
LIMIT_MARGIN = np.radians(4.0)
"""The model's limits are the hard ones; the robot's own soft limits lie this far inside."""
PAD_FRICTION = 1.0
GRIP_FORCE = 20.0
"""Newtons of each finger."""
FINGER_SPEED = 0.1


class Arm:
    """One Panda on a fixed base.

    Joint positions are arrays (7,) in radians; poses are (4, 4) of the grasp frame.

    Parameters
    ----------
    bullet : Bullet
    visible : bool
        Load what is needed to draw it, too.
    """

    def __init__(self, bullet: Bullet, visible: bool = False) -> None:
        self._bullet = bullet
        self.body: int = bullet.loadURDF(
            str(MODEL),
            useFixedBase=True,
            flags=0 if visible else pybullet.URDF_IGNORE_VISUAL_SHAPES,
        )
        joints = [bullet.getJointInfo(self.body, joint) for joint in JOINTS]
        self.lower = np.array([joint[8] for joint in joints]) + LIMIT_MARGIN
        self.upper = np.array([joint[9] for joint in joints]) - LIMIT_MARGIN
        self._torques = [joint[10] for joint in joints]
        self.link_names: dict[int, str] = {
            link: bullet.getJointInfo(self.body, link)[12].decode()
            for link in range(bullet.getNumJoints(self.body))
        }
        self._couple_fingers()

    def _couple_fingers(self) -> None:
        for finger in FINGERS:
            self._bullet.changeDynamics(
                self.body,
                finger,
                lateralFriction=PAD_FRICTION,
                # The model's 0.1 m would hold a long bar level by its end.
                spinningFriction=0.003,
                rollingFriction=0.0,
            )
        gear = self._bullet.createConstraint(
            self.body,
            LEFT_FINGER,
            self.body,
            RIGHT_FINGER,
            pybullet.JOINT_GEAR,
            [1, 0, 0],
            [0, 0, 0],
            [0, 0, 0],
        )
        self._bullet.changeConstraint(gear, gearRatio=-1, erp=0.1, maxForce=50)

    def stand_at(self, world_from_base: Array) -> None:
        """Put the robot's base somewhere else."""
        self._bullet.resetBasePositionAndOrientation(
            self.body, world_from_base[:3, 3], quaternion_from_matrix(world_from_base[:3, :3])
        )

    @property
    def world_from_base(self) -> Array:
        return matrix_from_pose(*self._bullet.getBasePositionAndOrientation(self.body))

    @property
    def joints(self) -> Array:
        """Where the joints are now."""
        return np.array([state[0] for state in self._bullet.getJointStates(self.body, JOINTS)])

    def set_joints(self, joints: Array) -> None:
        """Put the joints at these positions, at rest, without simulating."""
        for joint, position in enumerate(joints):
            self._bullet.resetJointState(self.body, joint, position)

    def set_opening(self, opening: float) -> None:
        """Put the pads this far apart, without simulating."""
        for finger in FINGERS:
            self._bullet.resetJointState(self.body, finger, opening / 2)

    @property
    def opening(self) -> float:
        """Distance between the pads, metres."""
        return float(sum(s[0] for s in self._bullet.getJointStates(self.body, FINGERS)))

    def world_from_grasp(self) -> Array:
        """Where the grasp frame is now."""
        state = self._bullet.getLinkState(self.body, HAND, computeForwardKinematics=True)
        return np.asarray(matrix_from_pose(state[4], state[5]) @ HAND_FROM_GRASP)

    def base_from_grasp(self, joints: Array) -> Array:
        """Forward kinematics; leaves the joints at `joints`."""
        self.set_joints(joints)
        return np.asarray(inverse(self.world_from_base) @ self.world_from_grasp())

    def jacobian(self, joints: Array) -> Array:
        """Return the Jacobian (6, 7) of the grasp frame: linear over angular, base axes."""
        positions = [*map(float, joints), 0.0, 0.0]
        zeros = [0.0] * len(positions)
        linear, angular = self._bullet.calculateJacobian(
            self.body, HAND, HAND_FROM_GRASP[:3, 3].tolist(), positions, zeros, zeros
        )
        return np.vstack([linear, angular])[:, :7]

    def drive(self, joints: Array, velocities: Array) -> None:
        """Set the arm motors' goal for the next step."""
        self._bullet.setJointMotorControlArray(
            self.body,
            JOINTS,
            pybullet.POSITION_CONTROL,
            targetPositions=joints,
            targetVelocities=velocities,
            forces=self._torques,
            positionGains=[0.4] * len(JOINTS),
        )

    def drive_fingers(self, opening: float) -> None:
        """Set the finger motors' goal; both press with at most `GRIP_FORCE`."""
        for finger in FINGERS:
            self._bullet.setJointMotorControl2(
                self.body,
                finger,
                pybullet.POSITION_CONTROL,
                targetPosition=opening / 2,
                force=GRIP_FORCE,
                maxVelocity=FINGER_SPEED,
            )

    def forces_on(self, other: int, links: Sequence[int] | None = None) -> dict[int, float]:
        """Return the normal force in newtons of each link of ours that touches body `other`."""
        forces: dict[int, float] = {}
        for contact in self._bullet.getContactPoints(bodyA=self.body, bodyB=other):
            link, force = contact[3], contact[9]
            if links is None or link in links:
                forces[link] = forces.get(link, 0.0) + force
        return forces

    def deepest_link(self, other: int, links: Sequence[int]) -> tuple[int, float] | None:
        """Return which of `links` is deepest inside body `other`, and how deep in metres."""
        inside = [
            (point[8], point[3])
            for point in self._bullet.getClosestPoints(self.body, other, 0.0)
            if point[3] in links and point[8] < 0
        ]
        if not inside:
            return None
        distance, link = min(inside)
        return link, -distance
