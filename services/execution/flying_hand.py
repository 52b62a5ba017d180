"""A parallel gripper that flies by itself: boxes for palm and fingers."""

from __future__ import annotations

import numpy as np
import pybullet
from numpy.typing import NDArray

from services.execution.bullet import Bullet
from services.execution.flying import PALM_MASS, Flying, pose_lists
from services.execution.gripper_boxes import parallel_boxes
from services.execution.outcome import Verdict, closed_on_nothing
from services.execution.world import World
from shared.schemas.gripper import ParallelGripper

Array = NDArray[np.float64]

LEFT, RIGHT = 0, 1
FINGERS = (LEFT, RIGHT)
FINGER_NAMES = ("the left finger", "the right finger")
FINGER_MASS = 0.1
PAD_FRICTION = 1.0
PAD_SPINNING_FRICTION = 0.003
"""Metres: what a pad of a finger's width resists in torsion is small, so a long bar hangs."""
FINGER_SPEED = 0.25
"""Metres a second of each finger."""
GEAR_STRENGTH = 2.5
"""Force of the gear between the fingers, in grip forces: they move as one."""


class FlyingHand(Flying):
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

    grips = len(FINGERS)
    """How many of `gripping` it takes to hold."""

    def __init__(
        self, bullet: Bullet, gripper: ParallelGripper, world_from_grasp: Array, opening: float
    ) -> None:
        self.gripper = gripper
        super().__init__(bullet, _add(bullet, gripper, world_from_grasp), world_from_grasp)
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
        self._drive_fingers(opening, 3 * gripper.force)

    def close(self) -> None:
        """Press the fingers together from the next step on."""
        self._drive_fingers(0.0, self.gripper.force)

    def closed(self, world: World) -> Verdict | None:
        """Return the verdict on fingers that have closed on nothing."""
        return None if self.gripping(world) else closed_on_nothing(self.opening)

    def after_step(self, world: World) -> None:
        """See a simulated step; fingers hold by contact alone."""

    def gripping(self, world: World) -> list[str]:
        """Return the names of the fingers that touch the object."""
        touching = self._touching(world)
        return [FINGER_NAMES[finger] for finger in FINGERS if finger in touching]

    def in_touch(self, world: World) -> bool:
        """Whether any part of the hand touches the object."""
        return bool(self._touching(world))

    @property
    def opening(self) -> float:
        """Distance between the pads, metres."""
        return float(sum(s[0] for s in self._bullet.getJointStates(self.body, FINGERS)))

    def grip_in_words(self) -> str:
        """Return how it holds, for a message."""
        return f"stayed between the fingers, {1000 * self.opening:.1f} mm apart"

    def _touching(self, world: World) -> set[int]:
        contacts = self._bullet.getContactPoints(bodyA=self.body, bodyB=world.object)
        return {contact[3] for contact in contacts}

    def _drive_fingers(self, opening: float, force: float) -> None:
        for finger in FINGERS:
            self._bullet.setJointMotorControl2(
                self.body,
                finger,
                pybullet.POSITION_CONTROL,
                targetPosition=opening / 2,
                force=force,
                maxVelocity=FINGER_SPEED,
            )


def _add(bullet: Bullet, gripper: ParallelGripper, world_from_grasp: Array) -> int:
    """Add palm and fingers, closed; the body's frame is the grasp frame."""
    palm, left, right = parallel_boxes(gripper, 0.0)
    base = bullet.createCollisionShape(
        pybullet.GEOM_BOX, halfExtents=palm.half, collisionFramePosition=palm.centre
    )
    finger = bullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=left.half)
    position, quaternion = pose_lists(world_from_grasp)
    body: int = bullet.createMultiBody(
        PALM_MASS,
        base,
        basePosition=position,
        baseOrientation=quaternion,
        linkMasses=[FINGER_MASS] * 2,
        linkCollisionShapeIndices=[finger] * 2,
        linkVisualShapeIndices=[-1] * 2,
        linkPositions=[left.centre, right.centre],
        linkOrientations=[[0, 0, 0, 1]] * 2,
        linkInertialFramePositions=[[0, 0, 0]] * 2,
        linkInertialFrameOrientations=[[0, 0, 0, 1]] * 2,
        linkParentIndices=[0, 0],
        linkJointTypes=[pybullet.JOINT_PRISMATIC] * 2,
        linkJointAxis=[[0, 1, 0], [0, -1, 0]],
    )
    return body
