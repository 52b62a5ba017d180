"""The requests that try a grasp on what was recovered of an object, before anybody moves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from shared.schemas.execution import BELIEVED, ExecuteRequest
from shared.schemas.grasp import Pose
from shared.schemas.scene import SupportPlane

Array = NDArray[np.float64]

NOWHERE = 0.01
"""Metres: a sensor this close to the object's middle heads nowhere."""


def rehearsals(
    grasp: Array,
    superquadrics: Sequence[Sequence[float]],
    *,
    points: Array,
    viewpoint: tuple[float, float, float],
    plane: SupportPlane | None,
    up: tuple[float, float, float],
    gripper: str,
) -> list[ExecuteRequest]:
    """Return the requests, by `BELIEVED`, that a hand alone lifts, shakes and tilts the object.

    The robot is taken to face the object as its sensor does.

    Parameters
    ----------
    grasp : (9,) array
        A row of an answer.
    superquadrics : sequence of sequence of float
        Vectors of Eq. 3.3, all of the object.
    points : (N, 3) array
        Of the object.
    viewpoint : tuple of float
        Of the sensor.
    plane, up : SupportPlane or None, tuple of float
    gripper : str
    """
    x, y, z, qx, qy, qz, qw, width, _ = map(float, grasp)
    heading_x, heading_y, heading_z = (points.mean(axis=0) - viewpoint).tolist()
    bodies = tuple(tuple(map(float, each)) for each in superquadrics)
    somewhere = np.linalg.norm([heading_x, heading_y, heading_z]) > NOWHERE
    return [
        ExecuteRequest(
            pose=Pose(position=(x, y, z), quaternion=(qx, qy, qz, qw)),
            width=width,
            primitives=bodies,
            points=None if believed == "primitives" else points,
            viewpoint=viewpoint,
            believed=believed,
            plane=plane,
            up=up,
            gripper=gripper,
            actor="hand",
            strict=True,
            brisk=True,
            heading=(heading_x, heading_y, heading_z) if somewhere else None,
        )
        for believed in BELIEVED
    ]
