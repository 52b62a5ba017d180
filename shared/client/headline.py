"""An answer in one line."""

from __future__ import annotations

from shared.schemas.answer import GraspAnswer


def headline(answer: GraspAnswer) -> str:
    """Return the answer in one line."""
    question = f"{answer.task} ({answer.reasoning})"
    if answer.region is None:
        return f"{question}: no part of this object fits"
    parts = " and ".join(map(str, answer.region.primitive_ids))
    label = f" ({answer.region.affordance})" if answer.region.affordance else ""
    return f"{question}: hold part {parts}{label}, confidence {answer.region.confidence:.2f}"
