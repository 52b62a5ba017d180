"""The shape of the Panda hand in the grasp frame, from the model's own meshes."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from services.execution.arm import HAND_FROM_GRASP, MODEL
from shared.geometry.se3 import inverse, transform_points

Array = NDArray[np.float64]

FINGER_ROOT = np.array([0.0, 0.0, 0.0584])
"""Origin of both finger joints in the frame of `panda_hand`."""


def lowest_point(world_from_grasp: Array, opening: float) -> float:
    """Return the height in metres of the hand's lowest point at a grasp pose (4, 4)."""
    return float(transform_points(world_from_grasp, hand_points(opening))[:, 2].min())


def hand_points(opening: float) -> Array:
    """Return the corners (N, 3) of palm and fingers in the grasp frame."""
    palm, finger = _mesh_points("hand"), _mesh_points("finger")
    left = finger + FINGER_ROOT + [0.0, opening / 2, 0.0]
    right = finger * [-1.0, -1.0, 1.0] + FINGER_ROOT - [0.0, opening / 2, 0.0]
    return transform_points(inverse(HAND_FROM_GRASP), np.vstack([palm, left, right]))


@cache
def _mesh_points(name: str) -> Array:
    lines = (MODEL.parent / "meshes" / "collision" / f"{name}.obj").read_text().splitlines()
    return np.array([line.split()[1:4] for line in lines if line.startswith("v ")], dtype=float)
