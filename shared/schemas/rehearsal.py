"""Rehearsal: grasps tried in simulation before they are answered."""

from __future__ import annotations

from typing import Literal

from shared.wire import Message

Rehearsing = Literal["auto", "never", "always"]
"""`auto`: where a grasp is in doubt, as time allows; `always`: in doubt or not, or it is an
error."""


class Rehearsal(Message):
    """How grasps were rehearsed."""

    tried: int
    """So many grasps, the best ones, each on two shapes."""
    stopped: str | None = None
    """Code of the error that ended it; grasps in doubt are then answered unrehearsed."""
