"""The set of a film: robot or hand, table and object in a client of their own, off-screen.

Nothing here is simulated. PyBullet's own rasteriser (TinyRenderer) draws on the
processor, without a window or a graphics card, and always the same pixels.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pybullet
from numpy.typing import NDArray

from services.execution.arm import Arm
from services.execution.bullet import Bullet, physics
from services.execution.convex import write_obj
from services.execution.gripper_boxes import boxes
from services.execution.recording import Snapshot
from shared.geometry.rotation import quaternion_from_matrix
from shared.geometry.se3 import transform_points
from shared.schemas.gripper import ParallelGripper, SuctionGripper

Array = NDArray[np.float64]
Image = NDArray[np.uint8]
Colour = tuple[float, float, float, float]
AnyGripper = ParallelGripper | SuctionGripper

DRAWN = (640, 480)
"""Width and height in pixels; a film is smaller, which smooths the edges."""
EYE, TARGET = (1.22, -0.95, 0.66), (0.38, 0.0, 0.29)
"""Where it is seen from and what is in the middle, metres from the robot's base."""
FIELD_OF_VIEW = 44.0
"""Degrees, vertical."""
LIGHT_FROM = (0.6, -0.8, 1.6)
BACKDROP = (238, 241, 245)
"""Red, green, blue behind everything, 0..255."""
WOOD, LEG = (0.76, 0.62, 0.47, 1.0), (0.62, 0.49, 0.36, 1.0)
PALM, FINGER = (0.86, 0.87, 0.89, 1.0), (0.30, 0.33, 0.37, 1.0)
TABLE_MIDDLE, TABLE_HALF = (0.33, 0.0), (0.60, 0.42, 0.015)
LEG_HALF = (0.025, 0.025, 0.35)
NOTHING = -1
"""Of the segmentation image."""


@dataclass(frozen=True)
class Surface:
    """Triangles of one colour.

    Attributes
    ----------
    vertices : (V, 3) array
        Metres, in the object's body frame.
    faces : (F, 3) int32 array
    colour : tuple of float
        Red, green, blue, opacity in 0..1.
    """

    vertices: Array
    faces: NDArray[np.int32]
    colour: Colour


class Scenery:
    """Robot, table and object, put where they were and drawn.

    Parameters
    ----------
    bullet : Bullet
        An empty world.
    world_from_base : (4, 4) array
        Where the robot stands; table and camera go with it.
    surfaces : sequence of Surface
        The object.
    gripper : ParallelGripper or SuctionGripper, optional
        Is drawn by itself, in place of the robot.
    """

    def __init__(
        self,
        bullet: Bullet,
        world_from_base: Array,
        surfaces: Sequence[Surface],
        gripper: AnyGripper | None = None,
    ) -> None:
        self._bullet = bullet
        self._turn = quaternion_from_matrix(world_from_base[:3, :3])
        self._world_from_base = world_from_base
        self._gripper = gripper
        self.robot = None if gripper is not None else Arm(bullet, visible=True)
        self._hand: list[int] = []
        if self.robot is not None:
            self.robot.stand_at(world_from_base)
        if gripper is not None:
            colours = (PALM, FINGER, FINGER)
            for box, colour in zip(boxes(gripper, 0.0), colours, strict=False):
                self._hand.append(self._add_box(box.half, (0.0, 0.0, 0.0), colour))
        self._add_table()
        self._object = [self._add_surface(surface) for surface in surfaces]
        eye, target, light = self._placed(np.array([EYE, TARGET, LIGHT_FROM]))
        self._light = light - world_from_base[:3, 3]
        self._view = bullet.computeViewMatrix(eye, target, [0, 0, 1])
        self._lens = bullet.computeProjectionMatrixFOV(
            FIELD_OF_VIEW, DRAWN[0] / DRAWN[1], nearVal=0.2, farVal=6.0
        )

    def draw(self, snapshot: Snapshot) -> Image:
        """Return the picture (H, W, 3) of a moment."""
        if self.robot is not None and snapshot.joints is not None:
            self.robot.set_joints(snapshot.joints)
            self.robot.set_opening(snapshot.opening)
        if self._gripper is not None and snapshot.world_from_grasp is not None:
            grasp = snapshot.world_from_grasp
            turn = quaternion_from_matrix(grasp[:3, :3])
            for body, box in zip(self._hand, boxes(self._gripper, snapshot.opening), strict=True):
                (centre,) = transform_points(grasp, np.array([box.centre]))
                self._bullet.resetBasePositionAndOrientation(body, centre, turn)
        place = snapshot.world_from_body
        for body in self._object:
            self._bullet.resetBasePositionAndOrientation(
                body, place[:3, 3], quaternion_from_matrix(place[:3, :3])
            )
        width, height = DRAWN
        _, _, colours, _, things = self._bullet.getCameraImage(
            width,
            height,
            self._view,
            self._lens,
            lightDirection=self._light,
            shadow=0,
            renderer=pybullet.ER_TINY_RENDERER,
        )
        picture = np.reshape(colours, (height, width, 4))[..., :3].astype(np.uint8)
        empty = np.reshape(things, (height, width, 1)) == NOTHING
        return np.where(empty, np.array(BACKDROP, dtype=np.uint8), picture)

    def _placed(self, points: Array) -> Array:
        return transform_points(self._world_from_base, points)

    def _add_table(self) -> None:
        x, y = TABLE_MIDDLE
        self._add_box(TABLE_HALF, (x, y, -TABLE_HALF[2]), WOOD)
        reach = np.subtract(TABLE_HALF, LEG_HALF)[:2] - 0.02
        for side in (-1, 1):
            for end in (-1, 1):
                below = -2 * TABLE_HALF[2] - LEG_HALF[2]
                self._add_box(LEG_HALF, (x + end * reach[0], y + side * reach[1], below), LEG)

    def _add_box(
        self, half: Sequence[float], centre: tuple[float, float, float], colour: Colour
    ) -> int:
        shape = self._bullet.createVisualShape(
            pybullet.GEOM_BOX, halfExtents=half, rgbaColor=colour
        )
        (place,) = self._placed(np.array([centre]))
        body: int = self._bullet.createMultiBody(0, -1, shape, place, self._turn)
        return body

    def _add_surface(self, surface: Surface) -> int:
        with tempfile.TemporaryDirectory(prefix="sparge-film-") as folder:
            file = Path(folder, "surface.obj")
            write_obj(file, [(surface.vertices, surface.faces)])
            shape = self._bullet.createVisualShape(
                pybullet.GEOM_MESH, fileName=str(file), rgbaColor=surface.colour
            )
            body: int = self._bullet.createMultiBody(0, -1, shape)
        return body


@contextmanager
def scenery(
    world_from_base: Array, surfaces: Sequence[Surface], gripper: AnyGripper | None = None
) -> Iterator[Scenery]:
    """Yield the set; it is gone afterwards, whatever happens."""
    with physics() as bullet:
        yield Scenery(bullet, world_from_base, surfaces, gripper)
