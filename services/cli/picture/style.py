"""Colours of the picture."""

from __future__ import annotations

from matplotlib.colors import to_rgb

GRIPPER, OTHER_GRIPPER, TABLE, SHADOW = "#14213D", "#4F7CAC", "#F3F0EA", "#DDD7CB"


def darker(colour: str) -> tuple[float, float, float]:
    """Return a colour for lines and letters on `colour`."""
    red, green, blue = to_rgb(colour)
    return (0.6 * red, 0.6 * green, 0.6 * blue)
