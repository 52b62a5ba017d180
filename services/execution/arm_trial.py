"""A trial of the whole arm: drive, approach, close, lift, hold; strict: shake, tilt."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from services.execution.arm import FINGERS, HAND, HOME, Arm
from services.execution.bullet import TIME_STEP
from services.execution.kinematics import straight_line
from services.execution.outcome import (
    Held,
    Verdict,
    judged,
    missed,
    obstructed,
    pressed,
    pushed,
    shaken,
    unshaken,
)
from services.execution.placement import Obstruction, Plan, plan_motion
from services.execution.recording import Recorder
from services.execution.waypoints import LEFT, shake, tilt
from services.execution.world import SETTLE_S, World
from shared.geometry.se3 import inverse
from shared.schemas.execution import Phase

Array = NDArray[np.float64]

DRIVE_S, APPROACH_S, CLOSE_S, LIFT_S, HOLD_S = 1.5, 1.0, 0.75, 1.5, 1.0
PRESS_FORCE = 30.0
"""Newtons, mean over `FORCE_WINDOW` steps: the hand presses instead of moving in."""
FORCE_WINDOW = 24
POSES_PER_SECOND = 48
"""Of a leg of shake or tilt, that the inverse kinematics is asked for."""
PUSHED_DISTANCE = 0.04
PUSHED_ANGLE = np.radians(45.0)


class ArmTrial:
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
    strict : bool
        Shake and tilt, too.
    recorders : sequence of Recorder
        Watch the motion.
    side : (3,) array
        Along it the object is shaken, about it it is tilted.

    Attributes
    ----------
    rise : float
        How far the object's centre had risen at the end of the lift, metres.
    lifted : bool
        It was lifted and held, whatever came after.
    phases : list of Phase
    """

    def __init__(
        self,
        world: World,
        arm: Arm,
        world_from_grasp: Array,
        opening: float,
        strict: bool = False,
        recorders: Sequence[Recorder] = (),
        side: Array = LEFT,
    ) -> None:
        self._world = world
        self._arm = arm
        self._world_from_grasp = world_from_grasp
        self._opening = opening
        self._strict = strict
        self.rise = 0.0
        self.lifted = False
        self._recorders = recorders
        self._side = side
        self._steps = round(SETTLE_S / TIME_STEP)
        self.phases: list[Phase] = []
        self._end_phase("settle")

    def verdict(self) -> Verdict:
        """Plan, move, and judge."""
        plan = plan_motion(self._arm, self._world, self._world_from_grasp, self._opening)
        if isinstance(plan, Obstruction):
            return obstructed(plan)
        verdict = self._move(plan)
        self.rise = self._world.rise()
        self.lifted = verdict.outcome == "lifted"
        if not self.lifted or not self._strict:
            return verdict
        return self._shake(plan)

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

    def _shake(self, plan: Plan) -> Verdict:
        """Shake and tilt as far as the arm reaches, and judge again."""
        arm, world = self._arm, self._world
        high = arm.world_from_grasp()
        legs = [*shake(high, self._side), *tilt(high, self._side)]
        joints, paths = plan.lift[-1], []
        now = arm.joints
        for leg in legs:
            poses = max(1, round(leg.duration * POSES_PER_SECOND))
            path = self._joints_along(leg.poses(poses), joints)
            if path is None:
                arm.set_joints(now)
                return unshaken(leg.phase)
            paths.append(np.vstack([joints, path]))
            joints = path[-1]
        arm.set_joints(now)
        for leg, path, after in zip(legs, paths, [*legs[1:], None], strict=True):
            for _ in self._follow(leg.phase, path, leg.duration, opening=0.0):
                pass
            if after is None or after.phase != leg.phase:
                self._end_phase(leg.phase)
        left, right = self._pads()
        return shaken(Held(left, right, arm.opening, self.rise, world.stands_on_something()))

    def _joints_along(self, world_from_goals: list[Array], start: Array) -> Array | None:
        base_from_world = inverse(self._arm.world_from_base)
        return straight_line(
            self._arm, [base_from_world @ each for each in world_from_goals], start
        )

    def _pads(self) -> tuple[float, float]:
        forces = self._arm.forces_on(self._world.object)
        left, right = (forces.get(finger, 0.0) for finger in FINGERS)
        return left, right

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
        for recorder in self._recorders:
            recorder.watch(phase)
        self._arm.drive(goal, velocity)
        self._arm.drive_fingers(opening)
        self._world.step()
        self._steps += 1

    def _end_phase(self, name: str) -> None:
        self.phases.append(Phase(name=name, simulated_s=round(self._steps * TIME_STEP, 4)))
