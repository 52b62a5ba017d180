"""Grasps replayed by POST /execute on the object as it really is."""

from __future__ import annotations

import hashlib

import numpy as np
from numpy.typing import NDArray

from experiments.framework.views import ShownView
from shared.client import Sparge
from shared.geometry.se3 import pose_from_matrix
from shared.schemas.execution import EXECUTE, ExecuteRequest, ExecuteResponse
from shared.schemas.grasp import Pose
from shared.wire import NPZ, encode

GRIPPER = "panda"
AHEAD = (0.0, 0.0, 1.0)
"""Of the camera's frame: the robot faces what its camera looks at."""


class Replays:
    """Executes grasps on a backend; what was executed before is not executed again.

    The same request always gets the same answer, and both versions of the
    reasoning often end with the same grasp.
    """

    def __init__(self, sparge: Sparge) -> None:
        self._sparge = sparge
        self._known: dict[bytes, ExecuteResponse] = {}

    def execute(self, request: ExecuteRequest) -> ExecuteResponse:
        """Return what comes of a request."""
        key = hashlib.sha256(encode(request, NPZ)).digest()
        if key not in self._known:
            self._known[key] = self._sparge.call(EXECUTE, request)
        return self._known[key]


def free_hand(
    view: ShownView,
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    grasp: NDArray[np.float64],
    gripper: str = GRIPPER,
    mass: float | None = None,
) -> ExecuteRequest:
    """Return the request that a hand alone lifts, shakes and tilts the true object.

    It shakes to the left and right of the camera, and tilts away from it.

    Parameters
    ----------
    view : ShownView
        Where the object was seen; the table is right under it.
    vertices, faces : (V, 3), (F, 3) arrays
        The object's mesh in its own frame, the same for all of its views, so that
        it is prepared once.
    grasp : (9,) array
        A row of the answer, in the camera's frame.
    gripper : str
    mass : float, optional
        Of the object, kg; otherwise it is guessed by its volume.
    """
    x, y, z, qx, qy, qz, qw, width, _ = map(float, grasp)
    up_x, up_y, up_z = map(float, view.view.camera_from_world[:3, 2])
    position, quaternion = pose_from_matrix(view.view.camera_from_object)
    return ExecuteRequest(
        pose=Pose(position=(x, y, z), quaternion=(qx, qy, qz, qw)),
        width=width,
        vertices=vertices,
        faces=faces,
        object_pose=Pose(position=tuple(position.tolist()), quaternion=tuple(quaternion.tolist())),
        mass=mass,
        up=(up_x, up_y, up_z),
        gripper=gripper,
        actor="hand",
        strict=True,
        heading=AHEAD,
    )
