"""Hands that were left out, each with its reason on a click."""

from __future__ import annotations

import colorsys
from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
import viser

from services.viewer.drawing.answer import wxyz
from services.viewer.drawing.gripper import fork_mesh
from shared.palette import Rgb
from shared.schemas.answer import RejectedGrasp
from shared.schemas.gripper import Gripper
from shared.schemas.rejection import ORDER

GOLDEN = 0.618034
"""Of a turn: hues that far apart in turn stay apart, however many there are."""


def reason_colour(code: str) -> Rgb:
    """Return the colour of a reason, the same in every answer."""
    place = ORDER[code]
    value = (0.85, 0.6)[place % 2]
    red, green, blue = colorsys.hsv_to_rgb((0.55 + place * GOLDEN) % 1.0, 0.75, value)
    return round(255 * red), round(255 * green), round(255 * blue)


def legend(rejected: Sequence[RejectedGrasp]) -> str:
    """Return the reasons with their colours and how many hands each has, as HTML."""
    counts = Counter(each.reason.code for each in rejected)
    rows = [
        f'<div><span style="color: rgb{reason_colour(code)}">&#9632;</span> '
        f"{code.replace('_', ' ')} ({count})</div>"
        for code, count in sorted(counts.items(), key=lambda each: ORDER[each[0]])
    ]
    style = "font-size: 0.8em; padding: 0 1em; columns: 2"
    return f'<div style="{style}">{"".join(rows)}</div>' if rows else ""


def draw_rejected(
    scene: viser.SceneApi,
    rejected: Sequence[RejectedGrasp],
    gripper: Gripper,
    tell: Callable[[RejectedGrasp], None],
) -> list[viser.MeshHandle]:
    """Draw hands that were left out under `/answer/rejected`, a colour for each reason.

    Parameters
    ----------
    tell : callable
        Called with the hand that is clicked, which then bears its reason in the scene.
    """
    drawn = []
    for number, each in enumerate(rejected):
        vertices, faces = fork_mesh(gripper, each.width)
        handle = scene.add_mesh_simple(
            f"/answer/rejected/{number}",
            vertices,
            faces,
            color=reason_colour(each.reason.code),
            opacity=0.8,
            side="double",
            cast_shadow=False,
            wxyz=wxyz(np.asarray(each.pose.quaternion)),
            position=each.pose.position,
        )
        handle.on_click(partial(_told, scene, tell, each))
        drawn.append(handle)
    return drawn


def _told(
    scene: viser.SceneApi, tell: Callable[[RejectedGrasp], None], one: RejectedGrasp, _: object
) -> None:
    scene.add_label(
        "/answer/rejected/why",
        one.reason.code.replace("_", " "),
        position=one.pose.position,
        anchor="bottom-center",
    )
    tell(one)
