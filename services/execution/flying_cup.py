"""A suction cup that flies by itself: it holds by a joint until the load pulls it off."""

from __future__ import annotations

from collections import deque

import numpy as np
import pybullet
from numpy.typing import NDArray

from services.execution.bullet import TIME_STEP, Bullet
from services.execution.flying import PALM, PALM_MASS, Flying, pose_lists
from services.execution.gripper_boxes import suction_boxes
from services.execution.outcome import Verdict
from services.execution.seal import pulled_off, seal
from services.execution.world import World
from shared.geometry.se3 import inverse, transform_points
from shared.schemas.gripper import SuctionGripper

Array = NDArray[np.float64]

GRAVITY = np.array([0.0, 0.0, -9.81])
LOAD_WINDOW = 12
"""Steps that a load is averaged over: rubber evens out what is shorter than 50 ms."""
BOND = 1e4
"""Newtons of the joint while the seal holds: the cup's own limits decide, not the joint's."""


class FlyingCup(Flying):
    """A suction gripper whose palm is held at a pose in the world.

    Parameters
    ----------
    bullet : Bullet
    gripper : SuctionGripper
    world_from_grasp : (4, 4) array
        Where it appears.
    triangles : (T, 3, 3) array
        The object's surface in its body's frame, metres: what the lip seals on.
    """

    grips = 1

    def __init__(
        self, bullet: Bullet, gripper: SuctionGripper, world_from_grasp: Array, triangles: Array
    ) -> None:
        self.gripper = gripper
        self._triangles = triangles
        self._bond: int | None = None
        self._momenta: deque[tuple[Array, Array]] = deque(maxlen=LOAD_WINDOW + 1)
        self.lost_by = ""
        super().__init__(bullet, _add(bullet, gripper, world_from_grasp), world_from_grasp)

    opening = 0.0

    def close(self) -> None:
        """Switch the vacuum on; `closed` tells whether it built up."""

    def closed(self, world: World) -> Verdict | None:
        """Bond with the object where the lip seals; return the verdict when it does not."""
        grasp_from_body = inverse(self.world_from_grasp) @ world.world_from_body
        found = seal(self.gripper, transform_points(grasp_from_body, self._triangles))
        if not found.sealed:
            return Verdict("missed", f"the cup does not seal: {found.message}")
        body_from_grasp = inverse(grasp_from_body)
        position, quaternion = pose_lists(body_from_grasp)
        self._bond = self._bullet.createConstraint(
            self.body,
            PALM,
            world.object,
            -1,
            pybullet.JOINT_FIXED,
            [0, 0, 0],
            [0, 0, 0],
            position,
            [0, 0, 0, 1],
            quaternion,
        )
        self._bullet.changeConstraint(self._bond, maxForce=BOND)
        return None

    def after_step(self, world: World) -> None:
        """Let go when the load of the last steps pulls the cup off."""
        if self._bond is None:
            return
        self._momenta.append(self._momentum(world))
        if len(self._momenta) <= LOAD_WINDOW:
            return
        lasted = LOAD_WINDOW * TIME_STEP
        (linear_0, angular_0), (linear, angular) = self._momenta[0], self._momenta[-1]
        force = (linear - linear_0) / lasted - world.body.mass * GRAVITY
        place, grasp = world.world_from_body, self.world_from_grasp
        moment = (angular - angular_0) / lasted + np.cross(place[:3, 3] - grasp[:3, 3], force)
        turn = grasp[:3, :3].T
        if world.stands_on_something():
            return  # the table carries part of it
        why = pulled_off(self.gripper, turn @ force, turn @ moment)
        if why is not None:
            self._bullet.removeConstraint(self._bond)
            self._bond = None
            self.lost_by = why

    def gripping(self, world: World) -> list[str]:
        """Return the cup while it seals."""
        del world
        return ["the cup"] if self._bond is not None else []

    def in_touch(self, world: World) -> bool:
        """Whether the cup still seals."""
        return bool(self.gripping(world))

    def grip_in_words(self) -> str:
        """Return how it holds, for a message."""
        return "stayed on the cup"

    def _momentum(self, world: World) -> tuple[Array, Array]:
        """Return linear momentum and spin about the centre of mass, world axes."""
        linear, angular = map(np.array, self._bullet.getBaseVelocity(world.object))
        axes = world.world_from_body[:3, :3]
        return world.body.mass * linear, axes @ (world.body.inertia * (axes.T @ angular))


def _add(bullet: Bullet, gripper: SuctionGripper, world_from_grasp: Array) -> int:
    palm, cup = suction_boxes(gripper)
    shape = bullet.createCollisionShapeArray(
        [pybullet.GEOM_BOX] * 2,
        halfExtents=[palm.half, cup.half],
        collisionFramePositions=[palm.centre, cup.centre],
    )
    position, quaternion = pose_lists(world_from_grasp)
    body: int = bullet.createMultiBody(
        PALM_MASS, shape, basePosition=position, baseOrientation=quaternion
    )
    return body
