"""What an execution came to, in one word and in one sentence with numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from services.execution.placement import LIFT_HEIGHT, Obstruction
from shared.schemas.execution import Outcome

TOUCH_FORCE = 0.5
"""Newtons: what counts as a finger's contact."""
RISEN = 0.05
"""Metres that the centre of mass must rise: an object held by one end may hang."""


class Verdict(NamedTuple):
    """The outcome, and the message that explains it."""

    outcome: Outcome
    message: str


class Held(NamedTuple):
    """What is seen of the object at the end.

    Attributes
    ----------
    left, right : float
        Mean force of each finger on the object, newtons.
    opening : float
        Between the fingers, metres.
    rise : float
        Of the object's centre of mass, metres.
    standing : bool
        Whether it touches the table.
    """

    left: float
    right: float
    opening: float
    rise: float
    standing: bool


def too_wide(width: float, gripper: str, max_opening: float) -> Verdict:
    """Return the verdict on a grasp that the hand cannot open for."""
    return Verdict(
        "unreachable",
        f"the grasp needs an opening of {mm(width)}, {gripper} opens to {mm(max_opening)}",
    )


def palm_on_table() -> Verdict:
    """Return the verdict on a palm that comes down on the table."""
    return Verdict(
        "collision_with_table", "the palm touched the table during approach, before anything closed"
    )


def closed_on_nothing(opening: float) -> Verdict:
    """Return the verdict on fingers that closed (to `opening` metres) beside the object."""
    return Verdict("missed", f"the fingers closed to {mm(opening)}: on nothing")


def slipped(
    where: Outcome, gripping: Sequence[str], standing: bool, rise: float, lost_by: str = ""
) -> Verdict:
    """Return the verdict on a free hand that lost the object, or part of its hold."""
    hold = "nothing holds it"
    if lost_by:
        hold = f"it is off the cup, by {lost_by}"
    elif len(gripping) == 1:
        hold = f"only {gripping[0]} still touches it"
    elif gripping:
        hold = "it is between the fingers"
    table = " and it touches the table" if standing else ""
    return Verdict(where, f"in the end {hold}{table}; its centre rose by {mm(rise)} in the lift")


def kept(how: Outcome, rise: float, grip: str) -> Verdict:
    """Return the verdict on a free hand that kept the object to the end."""
    shaken = "" if how == "lifted" else ", was shaken and tilted"
    return Verdict(how, f"the object rose by {mm(rise)}{shaken} and {grip}")


def inside_table(where: str, depth: float) -> Verdict:
    """Return the verdict on a grasp whose hand would be inside the table."""
    return Verdict(
        "collision_with_table",
        f"at the {where} pose the hand would be {mm(depth)} inside the table",
    )


def obstructed(obstruction: Obstruction) -> Verdict:
    """Return the verdict on a grasp that no placement of the robot can carry out."""
    counts = ", ".join(f"{n} at the {name}" for name, n in obstruction.out_of_reach.items())
    if obstruction.reached == 0:
        return Verdict(
            "unreachable",
            f"none of {obstruction.tried} placements of the robot reaches the whole motion; "
            f"the arm gives up {counts}",
        )
    start = (
        f"{obstruction.reached} of {obstruction.tried} placements of the robot reach the motion, "
    )
    if obstruction.table is not None:
        link, depth = obstruction.table
        return Verdict(
            "collision_with_table",
            f"{start}none keeps off the table: at best, {link} would be {mm(depth)} inside it",
        )
    link, depth = obstruction.object or ("the arm", 0.0)
    return Verdict(
        "unreachable",
        f"{start}none has a free way: at best, {link} would be {mm(depth)} inside the object",
    )


def pressed(on: str, link: str, force: float, phase: str) -> Verdict:
    """Return the verdict on a motion that the table or the object resists."""
    return Verdict(
        "collision_with_table" if on == "table" else "pushed_away",
        f"{link} pressed on the {on} with {force:.0f} N during {phase}, before the fingers closed",
    )


def pushed(distance: float, angle: float) -> Verdict:
    """Return the verdict on an object that the approaching hand moved (metres, radians)."""
    return Verdict(
        "pushed_away",
        f"the approaching hand moved the object by {mm(distance)} and turned it by "
        f"{np.degrees(angle):.0f} degrees, before the fingers closed",
    )


def missed(left: float, right: float, opening: float) -> Verdict | None:
    """Return the verdict on closed fingers, or None when both press on the object."""
    touching = [name for name, force in (("left", left), ("right", right)) if force >= TOUCH_FORCE]
    if len(touching) == 2:
        return None
    what = f"only the {touching[0]} one touches the object" if touching else "on nothing"
    return Verdict("missed", f"the fingers closed to {mm(opening)}: {what}")


def judged(end: Held) -> Verdict:
    """Return the verdict on an object that was gripped and lifted."""
    if missed(end.left, end.right, end.opening) is not None:
        what = f"it left the fingers, which ended {mm(end.opening)} apart"
    elif end.standing:
        what = f"it still touches the table after a lift of {mm(LIFT_HEIGHT)}"
    elif end.rise < RISEN:
        what = "it hangs too low"
    else:
        return Verdict(
            "lifted",
            f"the object rose by {mm(end.rise)} and stayed between the fingers, "
            f"{mm(end.opening)} apart, which press with {end.left:.0f} N and {end.right:.0f} N",
        )
    return Verdict(
        "slipped_in_lift", f"the object was gripped, but {what}; it rose by {mm(end.rise)}"
    )


def shaken(end: Held) -> Verdict:
    """Return the verdict of the arm on an object that was lifted, shaken and tilted."""
    if missed(end.left, end.right, end.opening) is not None or end.standing:
        return Verdict(
            "slipped_in_shake",
            f"the object was lifted by {mm(end.rise)}, but shaken and tilted it left the "
            f"fingers, which ended {mm(end.opening)} apart",
        )
    return Verdict(
        "held",
        f"the object rose by {mm(end.rise)}, was shaken and tilted and stayed between the "
        f"fingers, {mm(end.opening)} apart",
    )


def unshaken(phase: str) -> Verdict:
    """Return the verdict on an object that was lifted where the arm cannot shake or tilt it."""
    return Verdict("unreachable", f"the object was lifted, but the arm cannot {phase} it there")


def mm(metres: float) -> str:
    """Return a length as people read it."""
    return f"{max(0.0, 1000 * metres):.1f} mm"
