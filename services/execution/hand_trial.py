"""A trial of a gripper that flies by itself: approach, close, lift, hold; strict: shake, tilt."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from services.execution import outcome
from services.execution.bullet import TIME_STEP
from services.execution.flying_cup import FlyingCup
from services.execution.flying_hand import FlyingHand
from services.execution.outcome import Verdict
from services.execution.recording import Recorder
from services.execution.waypoints import LEFT, Leg, approach, lift, shake, tilt
from services.execution.world import SETTLE_S, World
from shared.schemas.execution import Outcome, Phase

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
    hand : FlyingHand or FlyingCup
        At the start of its approach.
    world_from_grasp : (4, 4) array
    strict : bool
        Shake and tilt, too.
    recorders : sequence of Recorder
        Watch the motion.
    side : (3,) array
        Along it the object is shaken, about it it is tilted.
    pace : float
        How fast fingers close and the hand lifts, holds and tilts, in usual paces; the approach
        and the shaking are what they are.

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
        hand: FlyingHand | FlyingCup,
        world_from_grasp: Array,
        strict: bool,
        recorders: Sequence[Recorder] = (),
        side: Array = LEFT,
        pace: float = 1.0,
    ) -> None:
        self._world = world
        self._hand = hand
        self._world_from_grasp = world_from_grasp
        self._strict = strict
        self._recorders = recorders
        self._side = side
        self._pace = pace
        self.rise = 0.0
        self.lifted = False
        self._steps = round(SETTLE_S / TIME_STEP)
        self.phases: list[Phase] = []
        self._end_phase("settle")

    def verdict(self) -> Verdict:
        """Move, and judge."""
        problem = self._approach() or self._close()
        if problem is not None:
            return problem
        legs = self._paced(lift(self._world_from_grasp))
        kept = not self._dropped_during(legs) and self._held()
        self.rise = self._world.rise()
        if not kept:
            return self._slipped("slipped_in_lift")
        self.lifted = True
        if not self._strict:
            return self._kept("lifted")
        high = legs[-1].end
        moved_about = [*shake(high, self._side), *self._paced(tilt(high, self._side))]
        if self._dropped_during(moved_about) or not self._held():
            return self._slipped("slipped_in_shake")
        return self._kept("held")

    def _approach(self) -> Verdict | None:
        world, hand = self._world, self._hand
        leg = approach(self._world_from_grasp)
        for goal in leg.goals():
            self._step(leg.phase, goal)
            if hand.force_on(world.table) > 0:
                return outcome.palm_on_table()
            force = hand.force_on(world.object)
            if force > PRESS_FORCE:
                return outcome.pressed("object", "the palm", force, leg.phase)
        self._end_phase(leg.phase)
        moved, turned = world.displacement(world.rest)
        return outcome.pushed(moved, turned) if moved > PUSHED_DISTANCE else None

    def _close(self) -> Verdict | None:
        self._hand.close()
        for _ in range(round(CLOSE_S / self._pace / TIME_STEP)):
            self._step("close")
        self._end_phase("close")
        self._world.release()
        return self._hand.closed(self._world)

    def _paced(self, legs: Sequence[Leg]) -> list[Leg]:
        return [leg._replace(duration=leg.duration / self._pace) for leg in legs]

    def _dropped_during(self, legs: Sequence[Leg]) -> bool:
        """Move along legs; stop and return True as soon as the object is surely lost."""
        missing = 0
        for index, leg in enumerate(legs):
            for step, goal in enumerate(leg.goals()):
                self._step(leg.phase, None if leg.stands_still else goal)
                self._hand.after_step(self._world)
                if step % LOOK_EVERY == 0:
                    missing = 0 if self._hand.in_touch(self._world) else missing + 1
                    if missing == DROPPED_AFTER:
                        self._end_phase(leg.phase)
                        return True
            if index + 1 == len(legs) or legs[index + 1].phase != leg.phase:
                self._end_phase(leg.phase)
        return False

    def _held(self) -> bool:
        gripping = len(self._hand.gripping(self._world)) == self._hand.grips
        return gripping and not self._world.stands_on_something()

    def _slipped(self, where: Outcome) -> Verdict:
        hand, world = self._hand, self._world
        lost_by = hand.lost_by if isinstance(hand, FlyingCup) else ""
        return outcome.slipped(
            where, hand.gripping(world), world.stands_on_something(), self.rise, lost_by
        )

    def _kept(self, how: Outcome) -> Verdict:
        return outcome.kept(how, self.rise, self._hand.grip_in_words())

    def _step(self, phase: str, goal: tuple[list[float], list[float]] | None = None) -> None:
        for recorder in self._recorders:
            recorder.watch(phase)
        if goal is not None:
            self._hand.lead(*goal)
        self._world.step()
        self._steps += 1

    def _end_phase(self, name: str) -> None:
        self.phases.append(Phase(name=name, simulated_s=round(self._steps * TIME_STEP, 4)))
