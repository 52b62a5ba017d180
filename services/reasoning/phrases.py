"""Quantities of rules/quantities.pl in words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

Quantity = Sequence[Any]
"""Name and parts, as in ["thickness", 1], or ["share", quantity, quantity]."""

_NOUNS = {
    "thickness": "thickness",
    "width": "width",
    "length": "length",
    "volume": "volume",
    "along": "extent along the object",
    "across": "extent across the object",
    "stretch": "elongation along the object",
    "slant": "angle to the object's axis",
    "end_gap": "distance from the nearer end of the object",
    "reach": "reach out of part {}",
    "top": "height above the table",
    "bottom": "clearance above the table",
    "offset": "distance from the middle of part {} along it",
    "likeness": "likeness in cross-section to part {}",
    "filling": "share of the common box with part {} that is filled",
    "bend": "angle to part {}",
    "seen": "share of the points",
    "holes": "number of openings",
    "gripper_opening": "opening of the gripper",
    "object_length": "length of the object",
    "object_width": "width of the object",
}


def value_text(value: float, unit: str) -> str:
    """Return a value as people write it: `23 mm`, `0.7 times`, `35 degrees`."""
    match unit:
        case "m":
            return f"{millimetres(value)} mm"
        case "m3":
            return f"{value * 1e6:.3g} cm3"
        case "deg":
            return f"{value:.0f} degrees"
        case "count":
            return f"{value:.0f}"
        case _:
            return f"{value:.2g}"


def millimetres(metres: float) -> str:
    """Return a length in mm; one that would round to nothing keeps its digits."""
    value = metres * 1e3
    return f"{value:.0f}" if abs(value) >= 10 else f"{value:.2g}"


def measured_as(quantity: Quantity, value: str, bound: str) -> str:
    """Return what is said of a part whose quantity has this value, as `a width of 20 mm (...)`.

    The quantity's first part is the one that the sentence is about.
    """
    if quantity[0] != "share":
        article = "an" if noun(quantity)[0] in "aeiou" else "a"
        return f"{article} {noun(quantity)} of {value} ({bound})"
    one, other = quantity[1], quantity[2]
    if one[0] == other[0]:
        return f"{value} times the {noun(one)} of part {other[1]} ({bound})"
    article = "an" if noun(one)[0] in "aeiou" else "a"
    return f"{article} {noun(one)} of {value} times {_of(other, about=one)} ({bound})"


def named(quantity: Quantity, whose: str) -> str:
    """Return a quantity of a part, as `its width`; `whose` is `its` or `part 1's`."""
    if quantity[0] != "share":
        return f"the {noun(quantity)}" if len(quantity) == 1 else f"{whose} {noun(quantity)}"
    one, other = quantity[1], quantity[2]
    return f"{whose} {noun(one)}, relative to {_of(other, about=one)},"


def noun(quantity: Quantity) -> str:
    """Return the name of a quantity, without the part that it is of."""
    return _NOUNS[quantity[0]].format(*quantity[2:])


def _of(quantity: Quantity, *, about: Quantity) -> str:
    """Return whose quantity it is, seen from the part that `about` is of."""
    if len(quantity) == 1:
        return f"the {noun(quantity)}"
    if quantity[1] == about[1]:
        return f"its {noun(quantity)}"
    return f"the {noun(quantity)} of part {quantity[1]}"
