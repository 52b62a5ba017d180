"""Where the robot stands and how it moves: the first placement that reaches everything.

The request does not say where the camera is on the robot, so the base's place is
ours to choose. It stands on the table's level, facing the object, at the
distances and bearings below in that order; a bearing of zero is right behind
the grasp. A parallel hand turned half round about its approach direction is the
same grasp, so both are tried.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from services.execution.arm import FINGERS, HAND, HOME, Arm
from services.execution.kinematics import solutions, straight_line
from services.execution.world import World
from shared.geometry.se3 import inverse, pose_matrix

Array = NDArray[np.float64]

DISTANCES = (0.55, 0.65, 0.45)
BEARINGS = tuple(np.radians([0, 45, -45, 90, -90, 135, -135, 180]))
HALF_TURN = pose_matrix(np.zeros(3), np.diag([-1.0, -1.0, 1.0]))
PREGRASP_DISTANCE = 0.10
LIFT_HEIGHT = 0.30
LINE_SPACING = 0.02
CHECKED_POSTURES = 24
"""How many postures between home and pregrasp are checked for contact."""
ARM_LINKS = tuple(range(1, HAND))
"""Links that may touch neither table nor object: all but the bolted-down first two and the hand."""
ALL_LINKS = (*ARM_LINKS, HAND, *FINGERS)


@dataclass(frozen=True)
class Plan:
    """A place for the robot and the joint paths (K, 7) of its motion, in radians."""

    world_from_base: Array
    drive: Array
    approach: Array
    lift: Array


@dataclass
class Obstruction:
    """What stood in the way of the placements that were tried.

    Attributes
    ----------
    tried : int
    out_of_reach : dict of str to int
        How many placements could not reach pregrasp, grasp or lift.
    table, object : tuple of str and float, or None
        The shallowest arm link that would be inside the table or the object, and
        how deep in metres.
    """

    tried: int = 0
    out_of_reach: dict[str, int] = field(default_factory=dict)
    table: tuple[str, float] | None = None
    object: tuple[str, float] | None = None

    @property
    def reached(self) -> int:
        """How many placements reach the whole motion, were it free."""
        return self.tried - sum(self.out_of_reach.values())

    def note_unreached(self, what: str) -> None:
        """Count a placement from which `what` is out of reach."""
        self.out_of_reach[what] = self.out_of_reach.get(what, 0) + 1


def plan_motion(
    arm: Arm, world: World, world_from_grasp: Array, opening: float
) -> Plan | Obstruction:
    """Return the motion from the first placement that reaches everything freely.

    Parameters
    ----------
    arm : Arm
        Is moved about without simulating.
    world : World
        At rest.
    world_from_grasp : (4, 4) array
    opening : float
        Of the fingers on the way, metres.
    """
    obstruction = Obstruction()
    arm.set_opening(opening)
    for distance, bearing, turned in product(DISTANCES, BEARINGS, (False, True)):
        obstruction.tried += 1
        world_from_goal = world_from_grasp @ HALF_TURN if turned else world_from_grasp
        plan = _plan_from(arm, world, world_from_goal, _base(distance, bearing), obstruction)
        if plan is not None:
            return plan
    return obstruction


def _base(distance: float, bearing: float) -> Array:
    """Return world_from_base (4, 4): behind the object as seen along `bearing`, facing it."""
    turn = Rotation.from_euler("z", bearing).as_matrix()
    return pose_matrix(turn @ [-distance, 0.0, 0.0], turn)


def _plan_from(
    arm: Arm, world: World, world_from_goal: Array, world_from_base: Array, noted: Obstruction
) -> Plan | None:
    arm.stand_at(world_from_base)
    base_from_goal = inverse(world_from_base) @ world_from_goal
    back = shifted(base_from_goal, -PREGRASP_DISTANCE * base_from_goal[:3, 2])
    raised = shifted(base_from_goal, np.array([0.0, 0.0, LIFT_HEIGHT]))
    furthest = "pregrasp"
    for pregrasp in solutions(arm, back):
        approach = straight_line(arm, _line(back, base_from_goal), pregrasp)
        if approach is None:
            furthest = "grasp" if furthest == "pregrasp" else furthest
            continue
        lift = straight_line(arm, _line(base_from_goal, raised), approach[-1])
        if lift is None:
            furthest = "lift"
            continue
        drive = _between(HOME, pregrasp)
        if _is_free(arm, world, drive, np.vstack([approach, lift]), noted):
            return Plan(world_from_base, drive, np.vstack([pregrasp, approach]), lift)
        furthest = ""
    if furthest:
        noted.note_unreached(furthest)
    return None


def _is_free(arm: Arm, world: World, drive: Array, lines: Array, noted: Obstruction) -> bool:
    """Whether the arm touches neither table nor object where it should not.

    On the way to pregrasp nothing may touch; from there on the hand may (the
    simulation tells what happens then), the arm may not.
    """
    for postures, links in ((lines, ARM_LINKS), (drive, ALL_LINKS)):
        for joints in postures:
            arm.set_joints(joints)
            for name, other in (("table", world.table), ("object", world.object)):
                hit = arm.deepest_link(other, links)
                if hit is not None:
                    _note_hit(noted, name, arm.link_names[hit[0]], hit[1])
                    return False
    return True


def _note_hit(noted: Obstruction, name: str, link: str, depth: float) -> None:
    known = getattr(noted, name)
    if known is None or depth < known[1]:
        setattr(noted, name, (link, depth))


def shifted(pose: Array, shift: Array) -> Array:
    """Return a pose (4, 4) moved by `shift` (3,) along the axes it is given in."""
    return pose_matrix(pose[:3, 3] + shift, pose[:3, :3])


def _between(start: Array, end: Array) -> Array:
    return start + np.linspace(0, 1, CHECKED_POSTURES)[:, None] * (end - start)


def _line(start: Array, end: Array) -> list[Array]:
    """Return poses along the straight line from `start` (left out) to `end`, with its rotation."""
    way = end[:3, 3] - start[:3, 3]
    steps = max(1, round(float(np.linalg.norm(way)) / LINE_SPACING))
    return [shifted(end, (step / steps - 1) * way) for step in range(1, steps + 1)]
