"""What a film needs of a simulation: where everything was, a few times a second.

A recorder only reads, so that what is simulated is the same with and without it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.execution.arm import Arm
from services.execution.bullet import TIME_STEP
from services.execution.world import World

Array = NDArray[np.float64]

STEPS_PER_FRAME = 24
"""Ten frames per simulated second; GIF counts hundredths, 15 or 24 a second do not fit."""
FRAME_S = STEPS_PER_FRAME * TIME_STEP


@dataclass(frozen=True)
class Snapshot:
    """Where everything is at one moment.

    Attributes
    ----------
    phase : str
        What the robot is doing.
    joints : (7,) array
        Of the arm, radians.
    opening : float
        Between the pads, metres.
    world_from_body : (4, 4) array
        Centre of mass and principal axes of the object.
    """

    phase: str
    joints: Array
    opening: float
    world_from_body: Array


@dataclass(frozen=True)
class Recording:
    """A motion, `FRAME_S` simulated seconds from one snapshot to the next.

    Attributes
    ----------
    world_from_base : (4, 4) array
        Where the robot stands.
    snapshots : tuple of Snapshot
    """

    world_from_base: Array
    snapshots: tuple[Snapshot, ...]


class Recorder:
    """Takes a snapshot every `STEPS_PER_FRAME` steps of a motion.

    Parameters
    ----------
    world : World
    arm : Arm
    """

    def __init__(self, world: World, arm: Arm) -> None:
        self._world = world
        self._arm = arm
        self._steps = 0
        self._snapshots: list[Snapshot] = []

    def watch(self, phase: str) -> None:
        """See the beginning of a simulated step; call before each one."""
        if self._steps % STEPS_PER_FRAME == 0:
            self._take(phase)
        self._steps += 1

    def recording(self) -> Recording | None:
        """Return what was seen, and how it is now; None when nothing moved."""
        if not self._snapshots:
            return None
        self._take(self._snapshots[-1].phase)
        return Recording(self._arm.world_from_base, tuple(self._snapshots))

    def _take(self, phase: str) -> None:
        """Keep how things are, unless the simulation has diverged."""
        arm, place = self._arm, self._world.world_from_body
        if np.isfinite(place).all() and np.isfinite(arm.joints).all():
            self._snapshots.append(Snapshot(phase, arm.joints, arm.opening, place))
