"""Colours that pictures and pages share: of parts, of the region, of what is neither."""

from __future__ import annotations

PART_COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#8C6D31", "#6A51A3")
"""In turn; apart for all kinds of colour vision (after Okabe and Ito)."""
NO_PART, REST, REGION = "#9A9A9A", "#C4C4C4", "#D55E00"
TABLE = "#D8D2C6"

Rgb = tuple[int, int, int]


def rgb(colour: str) -> Rgb:
    """Return red, green and blue, 0 to 255, of a colour as in `#0072B2`."""
    red, green, blue = bytes.fromhex(colour.removeprefix("#"))
    return red, green, blue


def part_colour(number: int) -> str:
    """Return the colour of the part at a place in the answer's list."""
    return PART_COLOURS[number % len(PART_COLOURS)]
