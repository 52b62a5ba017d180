"""Conditions that no part can satisfy together."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from services.reasoning.problem import Problem
from shared.schemas.rule import RuleBody, RuleCondition, Word

_ASPECTS = ("thickness", "width", "length")


@dataclass(frozen=True)
class _Bound:
    """A condition of the rule and the numbers that it gives."""

    index: int
    values: tuple[float, ...]


def contradictions(rule: RuleBody, words: Mapping[str, Word]) -> list[Problem]:
    """Return why no object can satisfy a rule; each names the later of the conditions.

    It finds lower bounds above upper bounds, also between the ordered
    dimensions of a part and their ratio, a part that is to be of two classes,
    and a part that is to differ from itself. It does not find everything:
    a rule without a contradiction here may still match nothing.
    """
    return [
        *_different(rule),
        *_shapes(rule, words),
        *_numbers(rule, words),
        *_dimensions(rule, words),
    ]


def _different(rule: RuleBody) -> Iterator[Problem]:
    for index, each in enumerate(rule.conditions):
        if len(set(each.of)) < len(each.of):
            yield Problem(
                f"conditions.{index}.of", f"{each.condition} compares {each.of[0]!r} with itself"
            )


def _shapes(rule: RuleBody, words: Mapping[str, Word]) -> Iterator[Problem]:
    left: dict[tuple[str, ...], set[str]] = {}
    for index, each in enumerate(rule.conditions):
        if words[each.condition].takes != "shapes":
            continue
        names = {each.value} if isinstance(each.value, str) else set(_names(each))
        before = left.setdefault(each.of, names)
        left[each.of] = before & names
        if not left[each.of]:
            yield Problem(
                f"conditions.{index}.value", f"no class is left for the part {each.of[0]!r}"
            )


def _names(condition: RuleCondition) -> Sequence[str]:
    value = condition.value
    return [each for each in value if isinstance(each, str)] if isinstance(value, tuple) else []


def _numbers(rule: RuleBody, words: Mapping[str, Word]) -> Iterator[Problem]:
    quantities = {
        (word.quantity, each.of)
        for each in rule.conditions
        if (word := words[each.condition]).takes == "number" and word.quantity not in _ASPECTS
    }
    for quantity, parts in sorted(quantities, key=repr):
        low = _bounds(rule, words, "number", quantity, parts, "min")
        high = _bounds(rule, words, "number", quantity, parts, "max")
        if low and high:
            most = max(low, key=lambda bound: bound.values)
            least = min(high, key=lambda bound: bound.values)
            if most.values > least.values:
                yield Problem(
                    f"conditions.{max(most.index, least.index)}.value",
                    f"no part has a {quantity} of at least {most.values[0]:g} "
                    f"and at most {least.values[0]:g}",
                )


def _bounds(
    rule: RuleBody,
    words: Mapping[str, Word],
    takes: str,
    quantity: str | None,
    parts: tuple[str, ...],
    direction: str,
) -> list[_Bound]:
    found = []
    for index, each in enumerate(rule.conditions):
        word = words[each.condition]
        same = (word.takes, word.quantity, word.direction) == (takes, quantity, direction)
        if same and each.of == parts:
            values = each.value if isinstance(each.value, tuple) else (each.value,)
            found.append(_Bound(index, tuple(v for v in values if isinstance(v, float))))
    return found


def _dimensions(rule: RuleBody, words: Mapping[str, Word]) -> Iterator[Problem]:
    """Compare bounds on sorted dimensions, of which each is at least the one before it."""
    for parts in dict.fromkeys(each.of for each in rule.conditions):
        lows = _bounds(rule, words, "lengths", "dimension", parts, "min")
        highs = _bounds(rule, words, "lengths", "dimension", parts, "max")
        low, high = [0.0, 0.0, 0.0], [math.inf, math.inf, math.inf]
        used = [*lows, *highs]
        for i, aspect in enumerate(_ASPECTS):
            single = _bounds(rule, words, "number", aspect, parts, "min")
            used += single
            values = [bound.values[i] for bound in lows] + [bound.values[0] for bound in single]
            low[i] = max([low[max(i - 1, 0)], *values])
        for i, aspect in reversed(list(enumerate(_ASPECTS))):
            single = _bounds(rule, words, "number", aspect, parts, "max")
            used += single
            values = [bound.values[i] for bound in highs] + [bound.values[0] for bound in single]
            high[i] = min([high[min(i + 1, 2)], *values])
        last = max((bound.index for bound in used), default=0)
        impossible = [i for i in range(3) if low[i] > high[i] or high[i] == 0]
        if impossible:
            i = impossible[0]
            yield Problem(
                f"conditions.{last}.value",
                f"no part has a {_ASPECTS[i]} of at least {low[i]:g} m and at most {high[i]:g} m "
                "(dimensions are sorted: thickness, width, length)",
            )
            continue
        yield from _ratio(rule, words, parts, low, high)


def _ratio(
    rule: RuleBody,
    words: Mapping[str, Word],
    parts: tuple[str, ...],
    low: Sequence[float],
    high: Sequence[float],
) -> Iterator[Problem]:
    """Compare bounds on the ratio of length to thickness with those on the two."""
    slimmest = high[2] / low[0] if low[0] > 0 else math.inf
    stoutest = low[2] / high[0]
    for bound in _bounds(rule, words, "number", "ratio", parts, "min"):
        if bound.values[0] > slimmest:
            yield Problem(
                f"conditions.{bound.index}.value",
                f"the lengths allow a ratio of {slimmest:.4g} at most, found {bound.values[0]:g}",
            )
    for bound in _bounds(rule, words, "number", "ratio", parts, "max"):
        if bound.values[0] < stoutest:
            yield Problem(
                f"conditions.{bound.index}.value",
                f"the lengths ask for a ratio of {stoutest:.4g} at least, "
                f"found {bound.values[0]:g}",
            )
