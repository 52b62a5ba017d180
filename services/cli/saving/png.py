"""The answer as a PNG."""

from __future__ import annotations

from pathlib import Path

from services.cli.ask import Answered
from services.cli.picture import draw_answer
from shared.client import headline


def write_picture(path: Path, answered: Answered) -> None:
    """Draw parts, region and grasps."""
    answer = answered.result.answer
    points, assigned, region = answered.object_cloud()
    draw_answer(
        path,
        points,
        assigned,
        region,
        answer.primitives,
        answered.result.grasps,
        answer.scene.up,
        f"{answered.name}, {headline(answer)}",
        answered.viewpoint,
        _in_short(answered),
    )


def _in_short(answered: Answered) -> str:
    """Return why there is nothing to hold or no way to, or else the beginning of the reasons."""
    reason = answered.result.reason
    if reason is not None:
        return reason.message
    return ". ".join(answered.result.why.split(". ")[:2]).rstrip(".") + "."
