"""One PyBullet physics client: opened, bound to its functions, always closed."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

import pybullet

TIME_STEP = 1 / 240
"""Simulated seconds per step."""
SOLVER_ITERATIONS = 150
"""Of each step; with fewer, a held object creeps out of the pads."""


class Bullet:
    """The functions of `pybullet`, bound to one physics client.

    Attributes
    ----------
    client : int
        PyBullet's number for it.
    """

    def __init__(self, client: int) -> None:
        self.client = client

    def __getattr__(self, name: str) -> Any:
        return partial(getattr(pybullet, name), physicsClientId=self.client)


@contextmanager
def physics(iterations: int = SOLVER_ITERATIONS) -> Iterator[Bullet]:
    """Yield an empty world with gravity along -z; it is gone afterwards, whatever happens."""
    client = pybullet.connect(pybullet.DIRECT)
    try:
        bullet = Bullet(client)
        bullet.setGravity(0, 0, -9.81)
        bullet.setPhysicsEngineParameter(
            fixedTimeStep=TIME_STEP,
            numSolverIterations=iterations,
            deterministicOverlappingPairs=1,
            enableFileCaching=0,  # it would keep every mesh of every request
        )
        yield bullet
    finally:
        pybullet.disconnect(client)
