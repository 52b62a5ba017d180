"""Whether a task's definition can be used."""

from __future__ import annotations

from collections.abc import Collection

from shared.errors import InvalidInput
from shared.schemas.task import TaskDefinition


def checked(definition: TaskDefinition, affordances: Collection[str]) -> TaskDefinition:
    """Return `definition` with its relations sorted and each listed once.

    Raises
    ------
    InvalidInput
        It names an affordance that is not known, or no part to hold.
    """
    relations = {
        field: _checked_names(field, getattr(definition, field), affordances)
        for field in ("requires", "grasp", "avoids")
    }
    if not (relations["grasp"] or relations["avoids"]):
        raise InvalidInput(
            "a task says what to hold by grasp or avoids (lists of affordances), found neither",
            field="grasp",
            found=[],
            allowed=["grasp", "avoids"],
        )
    return definition.model_copy(update=relations)


def listed(names: Collection[str]) -> str:
    """Return `a, b, c` for a message."""
    return ", ".join(names) if names else "none"


def _checked_names(
    field: str, names: tuple[str, ...], affordances: Collection[str]
) -> tuple[str, ...]:
    unknown = sorted(set(names) - set(affordances))
    if unknown:
        raise InvalidInput(
            f"{field}: there is no affordance {listed(unknown[:5])}; "
            f"known are {listed(affordances)}",
            field=field,
            found=unknown[:5],
            known=sorted(affordances),
        )
    return tuple(sorted(set(names)))
