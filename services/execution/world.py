"""The table and the object in the simulator."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pybullet
from numpy.typing import NDArray

from services.execution.body import RigidBody
from services.execution.bullet import TIME_STEP, Bullet
from services.execution.convex import write_obj
from shared.geometry.rotation import quaternion_from_matrix
from shared.geometry.se3 import matrix_from_pose, transform_points

Array = NDArray[np.float64]

OBJECT_FRICTION = 0.6
TABLE_FRICTION = 0.5
TABLE_HALF = (1.5, 1.5, 0.02)
COLLISION_MARGIN = 0.0002
"""Metres that Bullet adds around the object; its default is a millimetre."""
SETTLE_S = 0.5
RESTLESS_M = 0.008
"""An object of which a point moves further than this by itself would not stand; it is propped."""


class World:
    """A table top at z = 0 and the object on it.

    Parameters
    ----------
    bullet : Bullet
        An empty world.
    body : RigidBody
        The object, where it was seen.
    """

    def __init__(self, bullet: Bullet, body: RigidBody) -> None:
        self.bullet = bullet
        self.body = body
        self.table = self._fixed_box(TABLE_HALF, (0.0, 0.0, -TABLE_HALF[2]))
        self.object = self._add_object(body)
        self.supports = [self.table]
        self.rest = body.world_from_body
        self._prop: int | None = None
        self._support_where_seen()

    def step(self) -> None:
        """Simulate one time step."""
        self.bullet.stepSimulation()

    def settle(self, propped: bool = True) -> None:
        """Let the object come to rest; where `propped`, prop it up if it would fall, tip or roll.

        A shape recovered from one view may not balance although the real object
        does, nor a true one whose parts are of one density here: a pan with a steel pot
        and a wooden handle, for one. The prop is a joint to the world that bears the
        object's weight and gives way to a push that is stronger; `release` takes it away.
        """
        for _ in range(round(SETTLE_S / TIME_STEP)):
            self.step()
        if propped and self._strayed() > RESTLESS_M:
            self._prop_up()
        self.rest = self.world_from_body

    @property
    def propped(self) -> bool:
        return self._prop is not None

    def release(self) -> None:
        """Take the prop away."""
        if self._prop is not None:
            self.bullet.removeConstraint(self._prop)
            self._prop = None

    @property
    def world_from_body(self) -> Array:
        """Where the object's centre of mass and principal axes are now, (4, 4)."""
        return matrix_from_pose(*self.bullet.getBasePositionAndOrientation(self.object))

    def displacement(self, reference: Array) -> tuple[float, float]:
        """Return how far (metres, radians) the object is from the pose `reference` (4, 4)."""
        now = self.world_from_body
        cosine = (np.trace(reference[:3, :3].T @ now[:3, :3]) - 1) / 2
        distance = float(np.linalg.norm(now[:3, 3] - reference[:3, 3]))
        return distance, float(np.arccos(np.clip(cosine, -1, 1)))

    def _strayed(self) -> float:
        """Return how far the corner that moved most is from where it was seen, metres."""
        corners = np.concatenate([part.vertices for part in self.body.parts])
        seen = transform_points(self.body.world_from_body, corners)
        now = transform_points(self.world_from_body, corners)
        return float(np.linalg.norm(now - seen, axis=1).max())

    def rise(self) -> float:
        """Return how far the centre of mass is above where it rested, in metres."""
        return float(self.world_from_body[2, 3] - self.rest[2, 3])

    def stands_on_something(self) -> bool:
        """Whether the object touches the table or what supports it."""
        return any(
            self.bullet.getContactPoints(bodyA=self.object, bodyB=support)
            for support in self.supports
        )

    def _prop_up(self) -> None:
        position, axes = self.body.world_from_body[:3, 3], self.body.world_from_body[:3, :3]
        quaternion = quaternion_from_matrix(axes)
        self.bullet.resetBasePositionAndOrientation(self.object, position, quaternion)
        self.bullet.resetBaseVelocity(self.object, [0, 0, 0], [0, 0, 0])
        self._prop = self.bullet.createConstraint(
            self.object,
            -1,
            -1,
            -1,
            pybullet.JOINT_FIXED,
            [0, 0, 0],
            [0, 0, 0],
            position,
            childFrameOrientation=quaternion,
        )
        self.bullet.changeConstraint(self._prop, maxForce=9.81 * self.body.mass)

    def _support_where_seen(self) -> None:
        """Put a block under an object that hovers; the robot passes through it.

        The lower side of an object is hidden from the camera, so what was
        recovered often ends above the table.
        """
        vertices = np.vstack(
            [part.moved(self.body.world_from_body).vertices for part in self.body.parts]
        )
        gap = float(vertices[:, 2].min())
        if gap < 0.001:
            return
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        half = (*((high - low)[:2] / 2 + 0.05), gap / 2)
        block = self._fixed_box(half, (*((low + high)[:2] / 2), gap / 2))
        self.bullet.setCollisionFilterGroupMask(block, -1, 0, 0)
        self.bullet.setCollisionFilterPair(block, self.object, -1, -1, 1)
        self.supports.append(block)

    def _fixed_box(self, half: tuple[float, ...], centre: tuple[float, ...]) -> int:
        shape = self.bullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half)
        box: int = self.bullet.createMultiBody(0, shape, basePosition=centre)
        self.bullet.changeDynamics(box, -1, lateralFriction=TABLE_FRICTION)
        return box

    def _add_object(self, body: RigidBody) -> int:
        with tempfile.TemporaryDirectory(prefix="sparge-object-") as folder:
            # One file with a group for each part: Bullet makes a hull of each. An array of
            # shapes would lose all but the first sixteen, without a word.
            file = Path(folder, "parts.obj")
            write_obj(file, ((part.vertices, part.faces) for part in body.parts))
            shape = self.bullet.createCollisionShape(pybullet.GEOM_MESH, fileName=str(file))
            added: int = self.bullet.createMultiBody(  # reads the file once more
                body.mass,
                shape,
                basePosition=body.world_from_body[:3, 3],
                baseOrientation=quaternion_from_matrix(body.world_from_body[:3, :3]),
            )
        self.bullet.changeDynamics(
            added,
            -1,
            localInertiaDiagonal=body.inertia,
            collisionMargin=COLLISION_MARGIN,
            lateralFriction=OBJECT_FRICTION,
            spinningFriction=0.002,
            rollingFriction=0.0005,
            linearDamping=0.04,
            angularDamping=0.04,
        )
        return added
