"""The bottle on the table: what the robot's camera sees, and what is really there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from experiments.camera import HeadCamera, StereoNoise, Table, place_on
from experiments.catalogue import CatalogueObject, resting_pose
from experiments.dataset.photograph import photograph
from experiments.dataset.scene import HEAD_HEIGHT
from experiments.dataset.scene import Scene as Placed
from experiments.framework import ShownView
from shared.geometry.se3 import transform_points
from shared.schemas.fields import Vector3

Array = NDArray[np.float64]

POSES: Mapping[str, tuple[float, float, float]] = MappingProxyType(
    {"flat": (1.0, 0.0, 0.0), "upright": (0.0, 0.0, 1.0)}
)
"""Name -> about which direction of the object's frame points up."""
TABLE = Table(height=0.8)
"""As high as the thesis's (6.6.1)."""
PLACE_X, PLACE_Y = (0.58, 0.74), (-0.14, 0.14)
"""Where the object stands, metres from the robot."""
JITTER_DEG = 25.0
"""Views are turned by equal steps about the vertical, and by up to so much more."""


@dataclass(frozen=True)
class Scene:
    """An object before the camera.

    Attributes
    ----------
    thing : CatalogueObject
    pose : str
        A name from `POSES`.
    number : int
        Which view.
    yaw_deg : float
        Turn about the vertical.
    shown : ShownView
        What a noisy depth camera sees, with the truth.
    vertices : (V, 3) array
        The object's mesh where it is, metres, in the camera's frame.
    up : tuple of float
        Against gravity, in the camera's frame.
    """

    thing: CatalogueObject
    pose: str
    number: int
    yaw_deg: float
    shown: ShownView
    vertices: Array
    up: Vector3

    def faces_of(self, task: str) -> NDArray[np.bool_]:
        """Return which faces (F,) of the mesh belong to the part to hold for a task."""
        names = self.thing.part_names
        held = [names.index(name) for name in self.thing.regions[task]]
        return np.isin(self.thing.surface.part, held)


def make_scene(thing: CatalogueObject, pose: str, number: int, views: int, seed: int) -> Scene:
    """Return view `number` of `views`; the same arguments give the same bytes.

    Parameters
    ----------
    thing : CatalogueObject
    pose : str
        A name from `POSES`.
    number, views : int
        The views' turns about the vertical differ by 360 / `views` degrees.
    seed : int
        Of place, jitter and noise.
    """
    rng = np.random.default_rng([seed, list(POSES).index(pose), number])
    yaw = 360 * number / views + rng.uniform(-JITTER_DEG, JITTER_DEG)
    position = (float(rng.uniform(*PLACE_X)), float(rng.uniform(*PLACE_Y)))
    world_from_object = place_on(
        TABLE, thing, resting_pose(thing, POSES[pose]), position=position, yaw_deg=yaw
    )
    looks_at = (TABLE.near + TABLE.depth / 2, 0.0, TABLE.height)
    world_from_camera = HeadCamera(HEAD_HEIGHT, looks_at).world_from_camera
    placed = Placed(TABLE, world_from_object, world_from_camera)
    view = photograph(thing, number, placed)
    x, y, z = view.camera_from_world[:3, 2]
    return Scene(
        thing=thing,
        pose=pose,
        number=number,
        yaw_deg=float(yaw % 360),
        shown=ShownView(view.with_noise(StereoNoise(), rng)),
        vertices=transform_points(view.camera_from_object, thing.vertices),
        up=(float(x), float(y), float(z)),
    )
