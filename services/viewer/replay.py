"""An execution, played again in the scene."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
import viser

from services.viewer.drawing.answer import Shown, wxyz
from services.viewer.drawing.gripper import gripper_mesh
from shared.geometry.se3 import matrix_from_pose, pose_from_matrix
from shared.schemas.execution import ExecuteResponse
from shared.schemas.gripper import Gripper

HAND = (60, 72, 88)
SPEED = 1.5
"""Of the replay, in simulated seconds a second."""
LATE_S = 0.1


def replay(
    scene: viser.SceneApi,
    shown: Shown,
    outcome: ExecuteResponse,
    gripper: Gripper,
    goes_on: Callable[[], bool],
    tell: Callable[[str], None],
) -> None:
    """Move what is drawn as it moved; returns when that is over, or when it shall not go on.

    Parameters
    ----------
    scene : viser.SceneApi
    shown : Shown
        The answer as it is drawn; moved, and not moved back.
    outcome : ExecuteResponse
        With the recorded motion; without one, as where nothing moved, nothing is played.
    goes_on : callable
        Asked before every picture.
    tell : callable
        Told the phase with every picture.
    """
    times, of_object = outcome.motion_times, outcome.motion_object
    of_hand, opening = outcome.motion_hand, outcome.motion_opening
    if times is None or of_object is None or of_hand is None or opening is None or not len(times):
        return
    shown.choose(None)
    for label in shown.labels.values():
        label.visible = False
    _, faces = gripper_mesh(gripper, 0.0)
    hand: viser.MeshHandle | None = None
    began = time.monotonic()
    for number, moment in enumerate(times - times[0]):
        late = time.monotonic() - began - moment / SPEED
        if late > LATE_S and number < len(times) - 1:
            continue  # a slow page sees fewer pictures, not a slower motion
        time.sleep(max(0.0, -late))
        if not goes_on():
            return
        tell(outcome.motion_phases[number])
        row = of_object[number]
        moved = matrix_from_pose(row[:3], row[3:])
        _place([*shown.parts.values(), shown.cloud, shown.glow], moved)
        vertices, _ = gripper_mesh(gripper, float(opening[number]))
        if hand is None:
            hand = scene.add_mesh_simple(
                "/answer/replay",
                vertices,
                faces,
                color=HAND,
                flat_shading=True,
                side="double",
            )
        hand.vertices = vertices.astype(np.float32)
        hand.position, hand.wxyz = of_hand[number, :3], np.array(wxyz(of_hand[number, 3:]))


def _place(
    handles: list[viser.MeshHandle | viser.PointCloudHandle | None], motion: np.ndarray
) -> None:
    position, quaternion = pose_from_matrix(motion)
    for handle in handles:
        if handle is not None:
            handle.position, handle.wxyz = position, np.array(wxyz(quaternion))
