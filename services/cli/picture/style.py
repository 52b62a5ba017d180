"""Colours of the picture."""

from __future__ import annotations

from matplotlib.colors import to_rgb

PART_COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#8C6D31", "#6A51A3")
NO_PART, REST, REGION = "#9A9A9A", "#C4C4C4", "#D55E00"
GRIPPER, OTHER_GRIPPER, TABLE, SHADOW = "#14213D", "#4F7CAC", "#F3F0EA", "#DDD7CB"


def darker(colour: str) -> tuple[float, float, float]:
    """Return a colour for lines and letters on `colour`."""
    red, green, blue = to_rgb(colour)
    return (0.6 * red, 0.6 * green, 0.6 * blue)
