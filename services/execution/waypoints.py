"""The way of a hand that flies: straight between waypoints, at constant speed, turning evenly."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

from services.execution.bullet import TIME_STEP
from shared.geometry.se3 import pose_matrix

Array = NDArray[np.float64]

APPROACH_DISTANCE = 0.10
LIFT_HEIGHT = 0.30
SHAKE = 0.03
"""Metres to either side."""
SHAKE_HZ = 2.0
SHAKE_PERIODS = 2
TILT = np.radians(60.0)
LEFT = np.array([0.0, 1.0, 0.0])
"""Of who looks along world x."""


class Leg(NamedTuple):
    """A straight piece of the way.

    Attributes
    ----------
    phase : str
    start, end : (4, 4) arrays
        Poses of the grasp frame in the world.
    duration : float
        Simulated seconds.
    """

    phase: str
    start: Array
    end: Array
    duration: float

    def goals(self) -> Iterator[tuple[list[float], list[float]]]:
        """Yield position and quaternion after each time step."""
        count = round(self.duration / TIME_STEP)
        share = np.arange(1, count + 1) / count
        start, end = self.start, self.end
        positions = start[:3, 3] + share[:, None] * (end[:3, 3] - start[:3, 3])
        ends = Rotation.from_matrix(np.stack([start[:3, :3], end[:3, :3]]))
        quaternions = Slerp([0.0, 1.0], ends)(share).as_quat()
        yield from zip(positions.tolist(), quaternions.tolist(), strict=True)

    def poses(self, count: int) -> list[Array]:
        """Return `count` poses (4, 4) along the leg, the start left out."""
        share = np.arange(1, count + 1) / count
        ends = Rotation.from_matrix(np.stack([self.start[:3, :3], self.end[:3, :3]]))
        turns = Slerp([0.0, 1.0], ends)(share).as_matrix()
        way = self.end[:3, 3] - self.start[:3, 3]
        return [
            pose_matrix(self.start[:3, 3] + each * way, turn)
            for each, turn in zip(share, turns, strict=True)
        ]

    @property
    def stands_still(self) -> bool:
        return bool(np.array_equal(self.start, self.end))


def moved(pose: Array, shift: Array) -> Array:
    """Return a pose (4, 4) moved by `shift` (3,) along the axes it is given in."""
    result = pose.copy()
    result[:3, 3] += shift
    return result


def approach(world_from_grasp: Array) -> Leg:
    """Return the last 10 cm, along +z of the grasp."""
    back = moved(world_from_grasp, -APPROACH_DISTANCE * world_from_grasp[:3, 2])
    return Leg("approach", back, world_from_grasp, 0.5)


def lift(world_from_grasp: Array) -> list[Leg]:
    """Return 30 cm straight up and a second of rest."""
    high = moved(world_from_grasp, np.array([0.0, 0.0, LIFT_HEIGHT]))
    return [Leg("lift", world_from_grasp, high, 1.5), Leg("hold", high, high, 1.0)]


def shake(high: Array, side: Array = LEFT) -> list[Leg]:
    """Return swings of 3 cm to either side, with sudden turns, ending where begun.

    `side` is a level direction (3,) of length 1.
    """
    left, right = (moved(high, sign * SHAKE * side) for sign in (1, -1))
    ways = [(high, left), (right, left), (left, right), (right, left)]
    half = 1 / (2 * SHAKE_HZ)
    legs = [Leg("shake", start, end, half) for start, end in ways]
    return [*legs, Leg("shake", left, high, half / 2)]


def tilt(high: Array, side: Array = LEFT) -> list[Leg]:
    """Return a turn by 60 degrees about `side`, forward where that is left, and half a second."""
    turned = high.copy()
    turned[:3, :3] = Rotation.from_rotvec(TILT * side).as_matrix() @ high[:3, :3]
    return [Leg("tilt", high, turned, 1.0), Leg("tilt", turned, turned, 0.5)]
