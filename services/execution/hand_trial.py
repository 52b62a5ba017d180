"""A trial of a gripper that flies by itself: approach, close, lift, hold; strict: shake, tilt."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from services.execution import outcome
from services.execution.bullet import TIME_STEP
from services.execution.flying_hand import FINGERS, LINK_NAMES, PALM, FlyingHand
from services.execution.outcome import Verdict
from services.execution.waypoints import Leg, approach, lift, shake, tilt
from services.execution.world import SETTLE_S, World
from shared.schemas.execution import Phase

Array = NDArray[np.float64]

CLOSE_S = 0.5
PRESS_FORCE = 30.0
"""Newtons of the palm on the object: it presses instead of moving in."""
PUSHED_DISTANCE = 0.04
LOOK_EVERY = 24
"""Steps between two looks at whether the object has been dropped."""
DROPPED_AFTER = 3
"""Looks in a row without any contact: by then it has fallen some centimetres."""


class HandTrial:
    """A free hand and an object at rest, and the phases of the motion that are over.

    Parameters
    ----------
    world : World
        Settled.
    hand : FlyingHand
        At the start of its approach.
    world_from_grasp : (4, 4) array
    strict : bool
        Shake and tilt, too.
    """

    def __init__(
        self, world: World, hand: FlyingHand, world_from_grasp: Array, strict: bool
    ) -> None:
        self._world = world
        self._hand = hand
        self._world_from_grasp = world_from_grasp
        self._strict = strict
        self._steps = round(SETTLE_S / TIME_STEP)
        self.phases: list[Phase] = []
        self._end_phase("settle")

    def verdict(self) -> Verdict:
        """Move, and judge."""
        problem = self._approach()
        if problem is not None:
            return problem
        self._close()
        self._world.release()
        touching = self._fingers_touching()
        if not touching:
            return outcome.closed_on_nothing(self._hand.opening)
        legs = lift(self._world_from_grasp)
        if self._dropped_during(legs) or not self._held():
            return self._slipped("slipped_in_lift")
        if not self._strict:
            return self._kept("lifted")
        high = legs[-1].end
        if self._dropped_during([*shake(high), *tilt(high)]) or not self._held():
            return self._slipped("slipped_in_shake")
        return self._kept("held")

    def _approach(self) -> Verdict | None:
        world, hand = self._world, self._hand
        leg = approach(self._world_from_grasp)
        for goal in leg.goals():
            self._step(goal)
            if hand.force_on(world.table, PALM) > 0:
                return outcome.palm_on_table()
            force = hand.force_on(world.object, PALM)
            if force > PRESS_FORCE:
                return outcome.pressed("object", LINK_NAMES[PALM], force, leg.phase)
        self._end_phase(leg.phase)
        moved, turned = world.displacement(world.rest)
        return outcome.pushed(moved, turned) if moved > PUSHED_DISTANCE else None

    def _close(self) -> None:
        self._hand.drive_fingers(0.0, self._hand.gripper.force)
        for _ in range(round(CLOSE_S / TIME_STEP)):
            self._step()
        self._end_phase("close")

    def _dropped_during(self, legs: Sequence[Leg]) -> bool:
        """Move along legs; stop and return True as soon as the object is surely lost."""
        missing = 0
        for index, leg in enumerate(legs):
            for step, goal in enumerate(leg.goals()):
                self._step(None if leg.stands_still else goal)
                if step % LOOK_EVERY == 0:
                    missing = 0 if self._hand.touching(self._world.object) else missing + 1
                    if missing == DROPPED_AFTER:
                        self._end_phase(leg.phase)
                        return True
            if index + 1 == len(legs) or legs[index + 1].phase != leg.phase:
                self._end_phase(leg.phase)
        return False

    def _fingers_touching(self) -> list[int]:
        touching = self._hand.touching(self._world.object)
        return [finger for finger in FINGERS if finger in touching]

    def _held(self) -> bool:
        world = self._world
        return len(self._fingers_touching()) == len(FINGERS) and not world.stands_on_something()

    def _slipped(self, where: str) -> Verdict:
        names = [LINK_NAMES[finger] for finger in self._fingers_touching()]
        return outcome.slipped(
            where,  # type: ignore[arg-type]
            names,
            self._world.stands_on_something(),
            self._world.rise(),
        )

    def _kept(self, how: str) -> Verdict:
        return outcome.kept(how, self._world.rise(), self._hand.opening)  # type: ignore[arg-type]

    def _step(self, goal: tuple[list[float], list[float]] | None = None) -> None:
        if goal is not None:
            self._hand.lead(*goal)
        self._world.step()
        self._steps += 1

    def _end_phase(self, name: str) -> None:
        self.phases.append(Phase(name=name, simulated_s=round(self._steps * TIME_STEP, 4)))
