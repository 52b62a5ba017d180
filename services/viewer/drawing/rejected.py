"""Hands that were left out, each with its reason on a click."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
import viser

from services.viewer.drawing.answer import wxyz
from services.viewer.drawing.gripper import fork_mesh
from shared.palette import part_colour, rgb
from shared.schemas.answer import RejectedGrasp
from shared.schemas.gripper import Gripper


def draw_rejected(
    scene: viser.SceneApi,
    rejected: Sequence[RejectedGrasp],
    gripper: Gripper,
    tell: Callable[[str], None],
) -> list[viser.MeshHandle]:
    """Draw hands that were left out under `/answer/rejected`, a colour for each reason.

    Parameters
    ----------
    tell : callable
        Called with the reason of a hand that is clicked.
    """
    codes = sorted({each.reason.code for each in rejected})
    colours = {code: rgb(part_colour(k)) for k, code in enumerate(codes)}
    drawn = []
    for number, each in enumerate(rejected):
        vertices, faces = fork_mesh(gripper, each.width)
        handle = scene.add_mesh_simple(
            f"/answer/rejected/{number}",
            vertices,
            faces,
            color=colours[each.reason.code],
            opacity=0.5,
            side="double",
            cast_shadow=False,
            wxyz=wxyz(np.asarray(each.pose.quaternion)),
            position=each.pose.position,
        )
        handle.on_click(partial(_told, tell, each))
        drawn.append(handle)
    return drawn


def _told(tell: Callable[[str], None], one: RejectedGrasp, _: object) -> None:
    tell(f"left out: **{one.reason.code}**, {one.reason.message}")
