"""Measured conditions in words."""

from __future__ import annotations

from collections.abc import Sequence

from services.reasoning.phrases import measured_as, millimetres, named, value_text
from shared.errors import JsonObject

_MORE = {"thickness": "thicker", "width": "wider", "length": "longer"}
_LESS = {"thickness": "thinner", "width": "narrower", "length": "shorter"}


def apart(value: float, bound: float) -> str:
    """Return `value` with as many digits as it takes to read differently from `bound`."""
    for digits in range(4):
        if f"{value:.{digits}f}" != f"{bound:.{digits}f}":
            return f"{value:.{digits}f}"
    return f"{value:g}"


def size_of(dimensions: Sequence[float]) -> str:
    """Return dimensions, sorted ascending, as people write them."""
    return " x ".join(millimetres(each) for each in sorted(dimensions)) + " mm"


def joined(clauses: Sequence[object]) -> str:
    """Return `a, b and c`."""
    texts = [str(clause) for clause in clauses]
    return " and ".join([", ".join(texts[:-1]), texts[-1]] if len(texts) > 1 else texts)


def holding_clause(condition: JsonObject) -> str:
    """Return why a condition holds, to follow the part's name; empty for the obvious ones."""
    kind, required, margin = (condition[key] for key in ("kind", "required", "margin"))
    match kind:
        case "min_dimension" if margin is not None:
            return f"is at least {size_of(required)} ({millimetres(margin)} mm to spare)"
        case "max_dimension":
            return f"is at most {size_of(required)} ({millimetres(margin)} mm to spare)"
        case "min_ratio":
            return f"is {condition['measured']:.1f} times as long as thick (at least {required:g})"
        case "max_ratio":
            return f"is {condition['measured']:.1f} times as long as thick (at most {required:g})"
        case "max_shape":
            return "is the largest part"
        case "min_shape":
            return "is the smallest part"
        case "shape":
            return f"is a {condition['measured']}"
        case "at_least" | "at_most":
            bound = f"{_limit(kind)} {value_text(required, condition['unit'])}"
            value = value_text(condition["measured"], condition["unit"])
            return f"has {measured_as(condition['quantity'], value, bound)}"
        case "meets":
            return f"meets part {condition['measured'][1]}"
        case "fits_gripper" if required is not None:
            return (
                f"fits between the fingers ({millimetres(condition['measured'])} mm where the "
                f"gripper opens {millimetres(required)} mm)"
            )
        case "absent" if condition["part"] is not None:
            return f"does not count as {condition['measured']}"
        case "other":
            return f"satisfies {condition['predicate']}"
        case _:
            return ""


def failing_wish(condition: JsonObject, *, own: bool) -> str:
    """Return what would have to be different, as in `it were 4 mm thinner`.

    Parameters
    ----------
    condition : dict
        A condition that fails.
    own : bool
        It is about the part that the sentence is about.
    """
    who = "it" if own or condition["part"] is None else f"part {condition['part']}"
    kind, required = condition["kind"], condition["required"]
    match kind:
        case "min_dimension" | "max_dimension":
            words = _MORE if kind == "min_dimension" else _LESS
            limit = "at least" if kind == "min_dimension" else "at most"
            changes = [
                f"{millimetres(out['by'])} mm {words[out['aspect']]} "
                f"({apart(out['measured'] * 1e3, out['required'] * 1e3)} mm where {limit} "
                f"{millimetres(out['required'])} mm is asked)"
                for out in condition["outside"]
            ]
            return f"{who} were {joined(changes)}"
        case "min_ratio" | "max_ratio":
            limit = "at least" if kind == "min_ratio" else "at most"
            return (
                f"{who} were {limit} {required:g} times as long as thick "
                f"(it is {apart(condition['measured'], required)} times)"
            )
        case "max_shape":
            share = 1 + condition["margin"]
            return f"{who} were the largest part (it has {share:.0%} of the volume of the largest)"
        case "min_shape":
            times = 1 - condition["margin"]
            return f"{who} were the smallest part (it has {times:.3g} times the smallest volume)"
        case "shape":
            return f"{who} were a {' or '.join(required)} instead of a {condition['measured']}"
        case "at_least" | "at_most" if condition["measured"] is not None:
            return _quantity_wish(condition, who)
        case "fits_gripper":
            return (
                f"{who} were {millimetres(-condition['margin'])} mm thinner, to fit between the "
                f"fingers ({apart(condition['measured'] * 1e3, required * 1e3)} mm where the "
                f"gripper opens {millimetres(required)} mm)"
            )
        case "meets":
            return f"{who} met part {condition['measured'][1]}"
        case "absent" if condition["part"] is None:
            return f"no part counted as {condition['measured']}"
        case "absent":
            return f"{who} did not count as {condition['measured']}"
        case "distinct":
            return "the object had another part for the other role"
        case _:
            return f"{condition['predicate']} held"


def _limit(kind: str) -> str:
    return "at least" if kind.startswith("at_least") else "at most"


def _told_apart(value: float, bound: float) -> str:
    """Return `value` in as few significant digits as tell it from `bound`."""
    texts = [(f"{value:.{digits}g}", f"{bound:.{digits}g}") for digits in (2, 3, 4, 6, 9)]
    return next((text for text, other in texts if text != other), texts[-1][0])


def _quantity_wish(condition: JsonObject, who: str) -> str:
    """Return `it were 4 mm thinner (27 mm where at most 23 mm is asked)` or the like."""
    kind, quantity, unit = condition["kind"], condition["quantity"], condition["unit"]
    found, required = condition["measured"], condition["required"]
    asked = f"{_limit(kind)} {value_text(required, unit)}"
    if unit == "m" and quantity[0] in _MORE:
        word = (_MORE if kind == "at_least" else _LESS)[quantity[0]]
        by = value_text(abs(found - required), unit)
        value = apart(found * 1e3, required * 1e3)
        return f"{who} were {by} {word} ({value} mm where {asked} is asked)"
    value = value_text(found, unit)
    if value == value_text(required, unit):
        value = _told_apart(found, required)
    whose = "its" if who == "it" else f"{who}'s"
    return f"{named(quantity, whose)} were {asked} (it is {value})"
