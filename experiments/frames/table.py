"""The table of docs/frames.md: where the tool centre point lies in each link."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from shared.grippers import load_grippers
from shared.grippers.kinematics import advance
from shared.schemas.gripper import Gripper

HEAD = (
    "| gripper | link | TCP in the link: xyz (mm) | rpy (degrees) | closed, farther along z by |\n"
    "| --- | --- | --- | --- | --- |"
)


def offsets() -> str:
    """Return the table in Markdown, a row per link of the shipped grippers."""
    return "\n".join([HEAD, *(row for each in load_grippers().values() for row in _rows(each))])


def _rows(gripper: Gripper) -> Iterator[str]:
    for link in gripper.urdf.links if gripper.urdf else ():
        xyz = ", ".join(f"{1000 * length + 0:.1f}" for length in link.xyz)
        rpy = ", ".join(f"{angle + 0:.0f}" for angle in np.degrees(link.rpy))
        forward = 1000 * advance(gripper.urdf, 0.0)
        moves = f"{forward:.1f} mm" if forward else ""
        yield f"| `{gripper.name}` | `{link.name}` | {xyz} | {rpy} | {moves} |"
