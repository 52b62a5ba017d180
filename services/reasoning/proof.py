"""Prolog's proof as the messages of the interface; nothing is decided here."""

from __future__ import annotations

from typing import Any

from shared.errors import JsonObject
from shared.schemas.task import Condition, RuleTrace

_UNITS = {"m": " m", "m3": " m3", "deg": " degrees", "count": "", "ratio": ""}


def trace_of(trace: JsonObject) -> RuleTrace:
    """Return one tried rule with its conditions."""
    return RuleTrace(
        rule=trace["rule"],
        holds=trace["holds"],
        bindings=trace["bindings"],
        conditions=tuple(map(condition_of, trace["conditions"])),
    )


def condition_of(condition: JsonObject) -> Condition:
    """Return one condition, with its numbers as text and its margin as a number."""
    measured, required = _texts(condition)
    return Condition(
        predicate=condition["predicate"],
        primitive_id=condition["part"],
        holds=condition["holds"],
        measured=measured,
        required=required,
        margin=condition["margin"],
        unit=condition["unit"],
    )


def _texts(condition: JsonObject) -> tuple[str, str]:
    kind, measured, required = (condition[key] for key in ("kind", "measured", "required"))
    match kind:
        case "min_dimension" | "max_dimension":
            sign = ">=" if kind == "min_dimension" else "<="
            return _lengths(measured), f"{sign} {_lengths(required)}"
        case "min_ratio" | "max_ratio":
            sign = ">=" if kind == "min_ratio" else "<="
            return f"{measured:.4g}", f"{sign} {required:.4g}"
        case "max_shape" | "min_shape":
            sign = ">=" if kind == "max_shape" else "<="
            return _volume(measured), f"{sign} {_volume(required)}" if required else "any"
        case "shape":
            return str(measured), " or ".join(required)
        case "distinct":
            first, second = measured
            return f"part {first}, part {second}", "two different parts"
        case "at_least" | "at_most" if measured is not None:
            sign, unit = (">=" if kind == "at_least" else "<="), _UNITS[condition["unit"]]
            return f"{measured:.4g}{unit}", f"{sign} {required:.4g}{unit}"
        case "fits_gripper":
            return f"{measured:.4g} m", "any" if required is None else f"<= {required:.4g} m"
        case "meets":
            return ("touching" if condition["holds"] else "apart"), "touching"
        case "absent":
            state = "does not count as" if condition["holds"] else "counts as"
            if condition["part"] is None:
                state = "no part counts as" if condition["holds"] else "a part counts as"
                return f"{state} {measured}", f"no {measured}"
            return f"part {condition['part']} {state} {measured}", f"not {measured}"
        case "alone":
            return f"nothing but parts {measured}", f"parts that count as {required[0]}"
        case "relation":
            part = condition["part"]
            return f"part {part} counts as {measured}", f"a part that counts as {required[0]}"
        case "avoided":
            state = "does not count as" if condition["holds"] else "counts as"
            return f"part {condition['part']} {state} {measured}", f"not {required[0]}"
        case _:
            return ("holds" if condition["holds"] else "fails"), "holds"


def _lengths(values: list[Any]) -> str:
    return "[" + ", ".join(f"{value:.4f}" for value in values) + "] m"


def _volume(value: float) -> str:
    return f"{value * 1e6:.4g} cm3"
