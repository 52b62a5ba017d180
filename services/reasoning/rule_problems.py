"""What is wrong with a rule that was written as data, each with its place."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import get_args

from services.reasoning.bounds import contradictions
from services.reasoning.definition import listed
from services.reasoning.problem import Problem
from shared.schemas.primitive import ShapeClass
from shared.schemas.rule import RuleBody, RuleCondition, Word

MAX_PARTS = 4
_SHAPES = get_args(ShapeClass)


@dataclass(frozen=True)
class Terms:
    """What a rule may speak of: the words of the vocabulary, and the affordances."""

    words: Mapping[str, Word]
    affordances: Collection[str]


def problems_of(rule: RuleBody, terms: Terms, affordance: str | None = None) -> list[Problem]:
    """Return all that keeps `rule` from being used; empty if nothing does.

    Parameters
    ----------
    rule : RuleBody
    terms : Terms
    affordance : str, optional
        What the rule is for, when that is an affordance.
    """
    found = []
    if affordance is not None and affordance not in terms.affordances:
        known = listed(sorted(terms.affordances))
        found.append(
            Problem("affordance", f"there is no affordance {affordance!r}; known are {known}")
        )
    found += [
        problem
        for index, condition in enumerate(rule.conditions)
        for problem in _condition(f"conditions.{index}", condition, terms)
    ]
    parts = {rule.part, *(name for each in rule.conditions for name in each.of)}
    if len(parts) > MAX_PARTS:
        found.append(Problem("conditions", f"a rule is about {MAX_PARTS} parts at most"))
    if not found and all(rule.part not in each.of for each in rule.conditions):
        found.append(Problem("part", f"no condition is about {rule.part!r}, the part to find"))
    return found or contradictions(rule, terms.words)


def _condition(field: str, condition: RuleCondition, terms: Terms) -> list[Problem]:
    word = terms.words.get(condition.condition)
    if word is None:
        said = f"there is no {condition.condition!r}; known are {listed(sorted(terms.words))}"
        return [Problem(f"{field}.condition", said)]
    found = []
    if len(condition.of) != word.parts:
        number = "one part" if word.parts == 1 else f"{word.parts} parts"
        said = f"{word.name} is about {number}, found {listed(condition.of)}"
        found.append(Problem(f"{field}.of", said))
    if problem := _value(condition.value, word, terms):
        found.append(Problem(f"{field}.value", f"{word.name} {problem}"))
    return found


def _value(value: object, word: Word, terms: Terms) -> str | None:
    """Return what is wrong with the value of a condition, to follow the word."""
    match word.takes:
        case "nothing":
            return None if value is None else f"takes no value, found {value!r}"
        case "number":
            if not isinstance(value, float):
                return f"takes a number, found {value!r}"
            return _outside([value], word)
        case "lengths":
            if not (isinstance(value, tuple) and all(isinstance(each, float) for each in value)):
                return f"takes three lengths in metres, found {value!r}"
            return _outside([each for each in value if isinstance(each, float)], word)
        case "shapes":
            names = (value,) if isinstance(value, str) else value
            if not isinstance(names, tuple) or not names or set(names) - set(_SHAPES):
                return f"takes one or more of {listed(_SHAPES)}, found {value!r}"
        case "affordance":
            if not isinstance(value, str):
                return f"takes the name of an affordance, found {value!r}"
            if value not in terms.affordances:
                known = listed(sorted(terms.affordances))
                return f"asks for {value!r}, but known affordances are {known}"
    return None


def _outside(values: list[float], word: Word) -> str | None:
    low, high = word.low, word.high
    for value in values:
        if (low is not None and value < low) or (high is not None and value > high):
            return f"takes values in {low:g}..{high:g}, found {value:g}"
    return None
