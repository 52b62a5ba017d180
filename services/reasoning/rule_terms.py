"""A rule as the data that rules/learned.pl builds a clause from."""

from __future__ import annotations

from shared.errors import JsonObject
from shared.schemas.rule import RuleDefinition


def rule_for_prolog(rule: RuleDefinition) -> JsonObject:
    """Return an admitted rule as names and numbers; no text of it is ever read as Prolog."""
    return {
        "name": rule.name,
        "head": "affordTask" if rule.task is not None else "partAffordance",
        "subject": rule.task if rule.task is not None else rule.affordance,
        "part": rule.part,
        "conditions": [
            {"condition": each.condition, "of": each.of, "value": each.value}
            for each in rule.conditions
        ],
    }
