"""One execution from start to verdict: settle, drive, approach, close, lift, hold."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from services.execution.arm import FINGERS, HAND, HOME, MAX_OPENING, Arm
from services.execution.body import rigid_body
from services.execution.bullet import TIME_STEP, physics
from services.execution.checks import ARMED
from services.execution.film import film
from services.execution.flying_hand import FlyingHand
from services.execution.hand import lowest_point
from services.execution.hand_trial import HandTrial
from services.execution.outcome import (
    Held,
    Verdict,
    inside_table,
    judged,
    missed,
    obstructed,
    pressed,
    pushed,
    too_wide,
)
from services.execution.placement import (
    PREGRASP_DISTANCE,
    Obstruction,
    Plan,
    plan_motion,
    shifted,
)
from services.execution.recording import Recorder
from services.execution.scene import Scene, scene_from_request
from services.execution.waypoints import approach
from services.execution.world import SETTLE_S, World
from shared.errors import InvalidInput
from shared.schemas.execution import ExecuteRequest, ExecuteResponse, Phase
from shared.schemas.gripper import ParallelGripper, SuctionGripper

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
PROPPED = "; the object, which would not stand by itself, was propped up until it was gripped"
LIFTED = ("lifted", "held", "slipped_in_shake")
PUSHED_DISTANCE = 0.04
PUSHED_ANGLE = np.radians(45.0)


def warm_up() -> None:
    """Load the robot once, so that its files are read and the first request is fast."""
    with physics() as bullet:
        Arm(bullet)


def execute(request: ExecuteRequest, gripper: ParallelGripper | SuctionGripper) -> ExecuteResponse:
    """Replay a checked request in a fresh world and say what happened.

    Raises
    ------
    DegenerateCloud, InvalidInput
        The object has no volume, or lies below the plane.
    """
    scene = scene_from_request(request)
    if isinstance(gripper, SuctionGripper):
        raise InvalidInput("suction is not implemented yet", field="gripper")
    if scene.width > gripper.max_opening:
        return _refused(too_wide(scene.width, gripper.name, gripper.max_opening))
    if request.actor == "hand" or gripper.name != ARMED:
        return _by_hand(request, scene, gripper)
    opening = min(scene.width + OPENING_MARGIN, MAX_OPENING)
    grasp = scene.world_from_grasp
    pregrasp = shifted(grasp, -PREGRASP_DISTANCE * grasp[:3, 2])
    lowest, where = min(
        (lowest_point(grasp, opening), "grasp"), (lowest_point(pregrasp, opening), "pregrasp")
    )
    if lowest < -TABLE_TOLERANCE:
        return _refused(inside_table(where, -lowest))
    raised = shifted(grasp, np.array([0.0, 0.0, max(0.0, TABLE_CLEARANCE - lowest)]))
    body = rigid_body(scene.parts)
    with physics() as bullet:
        world = World(bullet, body)
        world.settle()
        arm = Arm(bullet)
        recorder = Recorder(world, arm) if request.animate else None
        answer = Run(world, arm, raised, opening, recorder).answer()
        recording = recorder.recording() if recorder is not None else None
    if recording is None:
        return answer
    animation = film(request, scene, body, recording, answer.outcome)
    return answer.model_copy(update={"animation": animation})


def _by_hand(request: ExecuteRequest, scene: Scene, gripper: ParallelGripper) -> ExecuteResponse:
    """Replay a request with the gripper alone."""
    grasp = scene.world_from_grasp
    opening = min(scene.width + OPENING_MARGIN, gripper.max_opening)
    with physics() as bullet:
        world = World(bullet, rigid_body(scene.parts))
        world.settle(propped=request.vertices is None)
        hand = FlyingHand(bullet, gripper, approach(grasp).start, opening)
        propped = world.propped
        trial = HandTrial(world, hand, grasp, request.strict)
        verdict = trial.verdict()
        rise = world.rise()
    return ExecuteResponse(
        success=verdict.outcome == ("held" if request.strict else "lifted"),
        lifted=verdict.outcome in LIFTED,
        outcome=verdict.outcome,
        message=verdict.message + (PROPPED if propped else ""),
        lift_height=round(rise, 4),
        phases=tuple(trial.phases),
    )


def _refused(verdict: Verdict) -> ExecuteResponse:
    """Return the answer to a grasp that is not worth simulating."""
    return ExecuteResponse(
        success=False,
        lifted=False,
        outcome=verdict.outcome,
        message=verdict.message,
        lift_height=0.0,
        phases=(),
    )


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
    recorder : Recorder, optional
        Watches the motion.
    """

    def __init__(
        self,
        world: World,
        arm: Arm,
        world_from_grasp: Array,
        opening: float,
        recorder: Recorder | None = None,
    ) -> None:
        self._world = world
        self._arm = arm
        self._world_from_grasp = world_from_grasp
        self._opening = opening
        self._recorder = recorder
        self._steps = round(SETTLE_S / TIME_STEP)
        self._phases: list[Phase] = []
        self._end_phase("settle")

    def answer(self) -> ExecuteResponse:
        """Plan, move, and judge."""
        plan = plan_motion(self._arm, self._world, self._world_from_grasp, self._opening)
        propped = self._world.propped
        verdict = obstructed(plan) if isinstance(plan, Obstruction) else self._move(plan)
        rise = self._world.rise()
        if not np.isfinite(rise):
            verdict = Verdict("pushed_away", "the object flew off: its contacts diverged")
            rise = 0.0
        return ExecuteResponse(
            success=verdict.outcome == "lifted",
            lifted=verdict.outcome == "lifted",
            outcome=verdict.outcome,
            message=verdict.message + (PROPPED if propped else ""),
            lift_height=round(rise, 4),
            phases=tuple(self._phases),
        )

    def _move(self, plan: Plan) -> Verdict:
        arm, world = self._arm, self._world
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
        world.release()
        problem = missed(left, right, arm.opening)
        if problem is not None:
            return problem
        for _ in self._follow("lift", plan.lift, LIFT_S, opening=0.0):
            pass
        self._end_phase("lift")
        left, right = self._hold_still("hold", plan.lift[-1], HOLD_S)
        return judged(Held(left, right, arm.opening, world.rise(), world.stands_on_something()))

    def _advance(self, phase: str, path: Array, duration: float) -> Verdict | None:
        """Move along `path` with open fingers; stop when something resists."""
        recent: deque[tuple[float, float]] = deque(maxlen=FORCE_WINDOW)
        for _ in self._follow(phase, path, duration, self._opening):
            on_table = self._arm.forces_on(self._world.table)
            on_object = self._arm.forces_on(self._world.object)
            recent.append((sum(on_table.values()), sum(on_object.values())))
            means = np.sum(recent, axis=0) / FORCE_WINDOW
            for on, force, forces in zip(
                ("table", "object"), means, (on_table, on_object), strict=True
            ):
                if force > PRESS_FORCE:
                    link = max(forces, key=lambda each: forces[each], default=HAND)
                    return pressed(on, self._arm.link_names[link], float(force), phase)
        self._end_phase(phase)
        return None

    def _check_pushed(self) -> Verdict | None:
        moved, turned = self._world.displacement(self._world.rest)
        if moved > PUSHED_DISTANCE or turned > PUSHED_ANGLE:
            return pushed(moved, turned)
        return None

    def _follow(self, phase: str, path: Array, duration: float, opening: float) -> Iterator[None]:
        """Move along joints (K, 7), slow at both ends; yield after each step."""
        count = round(duration / TIME_STEP)
        time = np.arange(1, count + 1) / count
        share = time**2 * (3 - 2 * time) * (len(path) - 1)
        knots = np.arange(len(path))
        goals = np.column_stack([np.interp(share, knots, joint) for joint in path.T])
        velocities = np.gradient(goals, TIME_STEP, axis=0)
        velocities[-1] = 0.0
        for goal, velocity in zip(goals, velocities, strict=True):
            self._step(phase, goal, velocity, opening)
            yield

    def _hold_still(self, phase: str, joints: Array, duration: float) -> tuple[float, float]:
        """Press the fingers together; return each pad's mean force in the end, newtons."""
        recent: deque[list[float]] = deque(maxlen=FORCE_WINDOW)
        for _ in range(round(duration / TIME_STEP)):
            self._step(phase, joints, np.zeros_like(joints), 0.0)
            forces = self._arm.forces_on(self._world.object)
            recent.append([forces.get(finger, 0.0) for finger in FINGERS])
        self._end_phase(phase)
        left, right = np.mean(recent, axis=0)
        return float(left), float(right)

    def _step(self, phase: str, goal: Array, velocity: Array, opening: float) -> None:
        if self._recorder is not None:
            self._recorder.watch(phase)
        self._arm.drive(goal, velocity)
        self._arm.drive_fingers(opening)
        self._world.step()
        self._steps += 1

    def _end_phase(self, name: str) -> None:
        self._phases.append(Phase(name=name, simulated_s=round(self._steps * TIME_STEP, 4)))
