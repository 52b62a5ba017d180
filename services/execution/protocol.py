"""One execution from start to verdict: settle, drive, approach, close, lift, hold."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.execution.arm import FINGERS, HAND, HOME, MAX_OPENING, Arm
from services.execution.body import rigid_body
from services.execution.bullet import TIME_STEP, physics
from services.execution.hand import lowest_point
from services.execution.placement import (
    LIFT_HEIGHT,
    PREGRASP_DISTANCE,
    Obstruction,
    Plan,
    plan_motion,
    shifted,
)
from services.execution.scene import scene_from_request
from services.execution.world import SETTLE_S, World
from shared.schemas.execution import ExecuteRequest, ExecuteResponse, Outcome, Phase

Array = NDArray[np.float64]

OPENING_MARGIN = 0.01
"""The fingers open this much wider than the grasp needs, metres."""
TABLE_TOLERANCE = 0.005
"""A grasp this deep in the table is raised to its surface: planes are not known better."""
TABLE_CLEARANCE = 0.001
DRIVE_S, APPROACH_S, CLOSE_S, LIFT_S, HOLD_S = 1.5, 1.0, 0.75, 1.5, 1.0
PRESS_FORCE = 30.0
"""Newtons, mean over `FORCE_WINDOW` steps: the hand presses instead of moving in."""
FORCE_WINDOW = 24
PUSHED_DISTANCE = 0.04
PUSHED_ANGLE = np.radians(45.0)
TOUCH_FORCE = 0.5
"""Newtons: what counts as a pad's contact."""
RISEN = 0.05
"""Metres that the centre of mass must rise: an object held by one end may hang."""


class Verdict(NamedTuple):
    """The outcome, and the message that explains it."""

    outcome: Outcome
    message: str


def warm_up() -> None:
    """Load the robot once, so that its files are read and the first request is fast."""
    with physics() as bullet:
        Arm(bullet)


def execute(request: ExecuteRequest) -> ExecuteResponse:
    """Replay a checked request in a fresh world and say what happened.

    Raises
    ------
    DegenerateCloud, InvalidInput
        The object has no volume, or lies below the plane.
    """
    scene = scene_from_request(request)
    if scene.width > MAX_OPENING:
        return _answer(
            "unreachable",
            f"the grasp needs an opening of {_mm(scene.width)}, "
            f"the Panda hand opens to {_mm(MAX_OPENING)}",
        )
    opening = min(scene.width + OPENING_MARGIN, MAX_OPENING)
    grasp = scene.world_from_grasp
    pregrasp = shifted(grasp, -PREGRASP_DISTANCE * grasp[:3, 2])
    low, low_before = (lowest_point(pose, opening) for pose in (grasp, pregrasp))
    if min(low, low_before) < -TABLE_TOLERANCE:
        where = "grasp" if low <= low_before else "pregrasp"
        return _answer(
            "collision_with_table",
            f"at the {where} pose the hand would be {_mm(-min(low, low_before))} inside the table",
        )
    raised = max(0.0, TABLE_CLEARANCE - min(low, low_before))
    with physics() as bullet:
        world = World(bullet, rigid_body(scene.parts))
        world.settle()
        run = Run(world, Arm(bullet), shifted(grasp, np.array([0.0, 0.0, raised])), opening)
        return run.answer()


class Run:
    """A robot and an object at rest, and the phases of the motion that are over.

    Parameters
    ----------
    world : World
        Settled.
    arm : Arm
        Anywhere; it is placed by the plan.
    world_from_grasp : (4, 4) array
    opening : float
        Of the fingers before they close, metres.
    """

    def __init__(self, world: World, arm: Arm, world_from_grasp: Array, opening: float) -> None:
        self._world = world
        self._arm = arm
        self._world_from_grasp = world_from_grasp
        self._opening = opening
        self._steps = round(SETTLE_S / TIME_STEP)
        self._phases: list[Phase] = []
        self._end_phase("settle")

    def answer(self) -> ExecuteResponse:
        """Plan, move, and judge."""
        plan = plan_motion(self._arm, self._world, self._world_from_grasp, self._opening)
        verdict = _explain(plan) if isinstance(plan, Obstruction) else self._move(plan)
        return ExecuteResponse(
            success=verdict.outcome == "lifted",
            outcome=verdict.outcome,
            message=verdict.message,
            lift_height=round(self._world.rise(), 4),
            phases=tuple(self._phases),
        )

    def _move(self, plan: Plan) -> Verdict:
        arm = self._arm
        arm.stand_at(plan.world_from_base)
        arm.set_joints(HOME)
        arm.set_opening(self._opening)
        problem = (
            self._advance("drive", plan.drive, DRIVE_S)
            or self._advance("approach", plan.approach, APPROACH_S)
            or self._check_pushed()
        )
        if problem is not None:
            return problem
        left, right = self._hold_still("close", plan.approach[-1], CLOSE_S)
        self._world.release()
        if min(left, right) < TOUCH_FORCE:
            return Verdict("missed", _describe_miss(left, right, arm.opening))
        for _ in self._follow(plan.lift, LIFT_S, opening=0.0):
            pass
        self._end_phase("lift")
        left, right = self._hold_still("hold", plan.lift[-1], HOLD_S)
        return self._judge(left, right)

    def _advance(self, phase: str, path: Array, duration: float) -> Verdict | None:
        """Move along `path` with open fingers; stop when something resists."""
        recent: deque[tuple[float, float]] = deque(maxlen=FORCE_WINDOW)
        for _ in self._follow(path, duration, self._opening):
            on_table = self._arm.forces_on(self._world.table)
            on_object = self._arm.forces_on(self._world.object)
            recent.append((sum(on_table.values()), sum(on_object.values())))
            table, thing = np.sum(recent, axis=0) / FORCE_WINDOW
            if table > PRESS_FORCE:
                link = self._strongest(on_table)
                return Verdict(
                    "collision_with_table",
                    f"{link} pressed on the table with {table:.0f} N during {phase}",
                )
            if thing > PRESS_FORCE:
                link = self._strongest(on_object)
                return Verdict(
                    "pushed_away",
                    f"{link} pressed on the object with {thing:.0f} N during {phase}, "
                    "before the fingers closed",
                )
        self._end_phase(phase)
        return None

    def _check_pushed(self) -> Verdict | None:
        moved, turned = self._world.displacement(self._world.rest)
        if moved <= PUSHED_DISTANCE and turned <= PUSHED_ANGLE:
            return None
        return Verdict(
            "pushed_away",
            f"the approaching hand moved the object by {_mm(moved)} and turned it by "
            f"{np.degrees(turned):.0f} degrees, before the fingers closed",
        )

    def _judge(self, left: float, right: float) -> Verdict:
        rise, width = self._world.rise(), self._arm.opening
        standing = self._world.stands_on_something()
        if min(left, right) >= TOUCH_FORCE and not standing and rise >= RISEN:
            return Verdict(
                "lifted",
                f"the object rose by {_mm(rise)} and stayed for {HOLD_S:g} s between the fingers, "
                f"{_mm(width)} apart, which press with {left:.0f} N and {right:.0f} N",
            )
        if min(left, right) < TOUCH_FORCE:
            what = f"it left the fingers, which ended {_mm(width)} apart"
        elif standing:
            what = f"it still stood on the table after a lift of {_mm(LIFT_HEIGHT)}"
        else:
            what = "it hung too low"
        return Verdict("slipped", f"the object was gripped, but {what}; it rose by {_mm(rise)}")

    def _follow(self, path: Array, duration: float, opening: float) -> Iterator[None]:
        """Move along joints (K, 7), slow at both ends; yield after each step."""
        count = round(duration / TIME_STEP)
        time = np.arange(1, count + 1) / count
        share = time**2 * (3 - 2 * time) * (len(path) - 1)
        knots = np.arange(len(path))
        goals = np.column_stack([np.interp(share, knots, joint) for joint in path.T])
        velocities = np.gradient(goals, TIME_STEP, axis=0)
        velocities[-1] = 0.0
        for goal, velocity in zip(goals, velocities, strict=True):
            self._step(goal, velocity, opening)
            yield

    def _hold_still(self, phase: str, joints: Array, duration: float) -> tuple[float, float]:
        """Press the fingers together; return each pad's mean force in the end, newtons."""
        recent: deque[list[float]] = deque(maxlen=FORCE_WINDOW)
        for _ in range(round(duration / TIME_STEP)):
            self._step(joints, np.zeros_like(joints), 0.0)
            forces = self._arm.forces_on(self._world.object)
            recent.append([forces.get(finger, 0.0) for finger in FINGERS])
        self._end_phase(phase)
        left, right = np.mean(recent, axis=0)
        return float(left), float(right)

    def _step(self, goal: Array, velocity: Array, opening: float) -> None:
        self._arm.drive(goal, velocity)
        self._arm.drive_fingers(opening)
        self._world.step()
        self._steps += 1

    def _end_phase(self, name: str) -> None:
        self._phases.append(Phase(name=name, simulated_s=round(self._steps * TIME_STEP, 4)))

    def _strongest(self, forces: dict[int, float]) -> str:
        link = max(forces, key=lambda each: forces[each], default=HAND)
        return self._arm.link_names[link]


def _explain(obstruction: Obstruction) -> Verdict:
    """Return the verdict on a grasp that no placement of the robot can carry out."""
    if obstruction.table is not None:
        link, depth = obstruction.table
        return Verdict(
            "collision_with_table",
            f"none of {obstruction.tried} placements of the robot keeps off the table: "
            f"at best, {link} would be {_mm(depth)} inside it",
        )
    if obstruction.object is not None:
        link, depth = obstruction.object
        return Verdict(
            "unreachable",
            f"none of {obstruction.tried} placements of the robot has a free way: "
            f"at best, {link} would be {_mm(depth)} inside the object",
        )
    counts = ", ".join(f"{count} at the {name}" for name, count in obstruction.out_of_reach.items())
    return Verdict(
        "unreachable",
        f"the arm reaches this grasp from none of {obstruction.tried} places of its base "
        f"(joint limits or length; it gave up {counts})",
    )


def _describe_miss(left: float, right: float, opening: float) -> str:
    touched = [name for name, force in (("left", left), ("right", right)) if force >= TOUCH_FORCE]
    what = f"only the {touched[0]} finger touched the object" if touched else "on nothing"
    return f"the fingers closed to {_mm(opening)}: {what}"


def _answer(outcome: Outcome, message: str) -> ExecuteResponse:
    """Return the answer to a grasp that is not worth simulating."""
    return ExecuteResponse(
        success=False, outcome=outcome, message=message, lift_height=0.0, phases=()
    )


def _mm(metres: float) -> str:
    return f"{max(0.0, 1000 * metres):.1f} mm"
