"""The boxes that stand for a gripper, in the grasp frame: what is simulated and what is drawn."""

from __future__ import annotations

from typing import NamedTuple

from shared.schemas.gripper import ParallelGripper, SuctionGripper

Vector = tuple[float, float, float]


class Box(NamedTuple):
    """Half extents and centre, metres, axes of the grasp frame."""

    half: Vector
    centre: Vector


def parallel_boxes(gripper: ParallelGripper, opening: float) -> tuple[Box, Box, Box]:
    """Return palm, left and right finger with the pads `opening` metres apart."""
    x, y, z = gripper.palm_size
    root = gripper.tip_beyond_tcp - gripper.finger_length
    palm = Box((x / 2, y / 2, z / 2), (0.0, 0.0, root - z / 2))
    half = (gripper.finger_width / 2, gripper.finger_thickness / 2, gripper.finger_length / 2)
    beside, middle = (opening + gripper.finger_thickness) / 2, root + gripper.finger_length / 2
    return palm, Box(half, (0.0, beside, middle)), Box(half, (0.0, -beside, middle))


def suction_boxes(gripper: SuctionGripper) -> tuple[Box, Box]:
    """Return palm and cup; the cup ends where its lip is when it has given way fully."""
    x, y, z = gripper.palm_size
    palm = Box((x / 2, y / 2, z / 2), (0.0, 0.0, -gripper.cup_length - z / 2))
    length = max(gripper.cup_length - gripper.compliance, 1e-3)
    side = gripper.cup_diameter / 8**0.5  # the square inside the lip
    return palm, Box((side, side, length / 2), (0.0, 0.0, -gripper.cup_length + length / 2))


def boxes(gripper: ParallelGripper | SuctionGripper, opening: float) -> tuple[Box, ...]:
    """Return all boxes of a gripper, the palm first."""
    if isinstance(gripper, SuctionGripper):
        return suction_boxes(gripper)
    return parallel_boxes(gripper, opening)
