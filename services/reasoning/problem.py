"""One thing that is wrong with what a client sent."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from shared.errors import InvalidInput


@dataclass(frozen=True)
class Problem:
    """Where, as in `conditions.2.value`, and what."""

    field: str
    problem: str


def refused(what: str, problems: Sequence[Problem]) -> InvalidInput:
    """Return the error that tells all `problems`, in the form of the other invalid input."""
    shown = "; ".join(f"{each.field}: {each.problem}" for each in problems[:5])
    return InvalidInput(
        f"{what} cannot be used: {shown}",
        field=problems[0].field,
        fields=[{"field": each.field, "problem": each.problem} for each in problems[:20]],
    )
