"""What is kept of a simulation for a film or for the answer: where everything was, when.

A recorder only reads, so that what is simulated is the same with and without it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.execution.arm import Arm
from services.execution.bullet import TIME_STEP
from services.execution.flying_cup import FlyingCup
from services.execution.flying_hand import FlyingHand
from services.execution.world import World
from shared.geometry.se3 import pose_matrix

Array = NDArray[np.float64]

STEPS_PER_FRAME = 24
"""Ten frames per simulated second; GIF counts hundredths, 15 or 24 a second do not fit."""
FRAME_S = STEPS_PER_FRAME * TIME_STEP
STEPS_PER_SAMPLE = 10
"""Of a motion that is given as numbers: 24 per simulated second."""
WITHOUT_ROBOT = pose_matrix([-0.55, 0.0, 0.0], np.eye(3))
"""Where the film's table and camera are put when there is no robot."""


@dataclass(frozen=True)
class Snapshot:
    """Where everything is at one moment.

    Attributes
    ----------
    phase : str
        What the robot is doing.
    joints : (7,) array or None
        Of the arm, radians; None where the hand flies by itself.
    opening : float
        Between the pads, metres.
    world_from_body : (4, 4) array
        Centre of mass and principal axes of the object.
    world_from_grasp : (4, 4) array or None
        Of a hand that flies by itself.
    since_s : float
        Simulated seconds since the motion began.
    """

    phase: str
    joints: Array | None
    opening: float
    world_from_body: Array
    world_from_grasp: Array | None = None
    since_s: float = 0.0


@dataclass(frozen=True)
class Recording:
    """A motion, the same simulated time from one snapshot to the next; the last may be nearer.

    Attributes
    ----------
    world_from_base : (4, 4) array
        Where the robot stands, or would stand.
    snapshots : tuple of Snapshot
    """

    world_from_base: Array
    snapshots: tuple[Snapshot, ...]


class Recorder:
    """Takes a snapshot every `pace` steps of a motion.

    Parameters
    ----------
    world : World
    actor : Arm, FlyingHand or FlyingCup
    pace : int
        The film's, unless given.
    """

    def __init__(
        self, world: World, actor: Arm | FlyingHand | FlyingCup, pace: int = STEPS_PER_FRAME
    ) -> None:
        self._pace = pace
        self._world = world
        self._actor = actor
        self._steps = 0
        self._snapshots: list[Snapshot] = []

    def watch(self, phase: str) -> None:
        """See the beginning of a simulated step; call before each one."""
        if self._steps % self._pace == 0:
            self._take(phase)
        self._steps += 1

    def recording(self) -> Recording | None:
        """Return what was seen, and how it is now; None when nothing moved."""
        if not self._snapshots:
            return None
        self._take(self._snapshots[-1].phase)
        actor = self._actor
        base = actor.world_from_base if isinstance(actor, Arm) else WITHOUT_ROBOT
        return Recording(base, tuple(self._snapshots))

    def _take(self, phase: str) -> None:
        """Keep how things are, unless the simulation has diverged."""
        actor, place = self._actor, self._world.world_from_body
        joints: Array | None = None
        grasp: Array | None = None
        if isinstance(actor, Arm):
            joints = actor.joints
        else:
            grasp = actor.world_from_grasp
        seen = Snapshot(phase, joints, actor.opening, place, grasp, self._steps * TIME_STEP)
        if all(np.isfinite(each).all() for each in (place, joints, grasp) if each is not None):
            self._snapshots.append(seen)
