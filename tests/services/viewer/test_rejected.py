"""Hands that were left out: drawn where they are, told apart by colour, explained on a click."""

from __future__ import annotations

from typing import Any, get_args

import numpy as np

from services.viewer.drawing.rejected import draw_rejected, legend, reason_colour
from services.viewer.words import rejected_in_words
from shared.grippers.library import load_grippers
from shared.schemas.answer import RejectedGrasp, Rejection
from shared.schemas.grasp import Pose
from shared.schemas.rejection import WHY_REJECTED, RejectionCode


def hand(code: RejectionCode, x: float = 0.0) -> RejectedGrasp:
    return RejectedGrasp(
        pose=Pose(position=(x, 0.0, 0.5), quaternion=(0.0, 0.0, 0.0, 1.0)),
        width=0.04,
        reason=Rejection(code=code, message=WHY_REJECTED[code]),
    )


class Scene:
    """Remembers what it is told to show."""

    def __init__(self) -> None:
        self.shown: dict[str, dict[str, Any]] = {}
        self.clicks: dict[str, Any] = {}

    def add_mesh_simple(self, name: str, vertices: Any, faces: Any, **how: Any) -> Any:
        self.shown[name] = how
        scene = self

        class Handle:
            def on_click(self, call: Any) -> None:
                scene.clicks[name] = call

        return Handle()

    def add_label(self, name: str, text: str, **how: Any) -> None:
        self.shown[name] = {"text": text, **how}


def test_all_reasons_have_colours_that_can_be_told_apart() -> None:
    colours = np.array([reason_colour(code) for code in get_args(RejectionCode)], dtype=float)
    apart = np.linalg.norm(colours[:, None] - colours[None], axis=2)
    assert apart[~np.eye(len(colours), dtype=bool)].min() > 20


def test_a_click_tells_the_reason_in_panel_and_scene() -> None:
    scene, told = Scene(), list[RejectedGrasp]()
    hands = [hand("too_wide"), hand("sweep_collides", 0.1)]
    draw_rejected(scene, hands, load_grippers()["panda"], told.append)  # type: ignore[arg-type]
    assert scene.shown["/answer/rejected/1"]["position"] == (0.1, 0.0, 0.5)
    scene.clicks["/answer/rejected/1"](None)
    assert told == [hands[1]]
    assert scene.shown["/answer/rejected/why"]["text"] == "sweep collides"
    assert WHY_REJECTED["sweep_collides"] in rejected_in_words(told[0])


def test_the_legend_counts_each_reason_in_the_order_of_the_answers() -> None:
    text = legend([hand("sweep_collides"), hand("too_wide"), hand("sweep_collides")])
    assert text.index("too wide (1)") < text.index("sweep collides (2)")
    assert legend([]) == ""
