"""Grippers as meshes, from their data."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.schemas.gripper import Gripper, ParallelGripper, SuctionGripper

Array = NDArray[np.float64]
Faces = NDArray[np.int32]
Mesh = tuple[Array, Faces]
"""Vertices (V, 3) in metres and triangles (F, 3), counter-clockwise from outside."""

SEGMENTS = 24
THIN = 0.0025
"""Metres."""


def gripper_mesh(gripper: Gripper, width: float) -> Mesh:
    """Return a gripper in the grasp frame: +z approaches, +y closes, the origin is the TCP.

    Parameters
    ----------
    gripper : Gripper
    width : float
        How far the fingers are open, metres; nothing to a cup.
    """
    if isinstance(gripper, SuctionGripper):
        return _joined(_cup(gripper))
    return _joined(_fingers(gripper, min(width, gripper.max_opening)))


def fork_mesh(gripper: Gripper, width: float) -> Mesh:
    """Return a hint of a gripper: thin fingers on a thin bar, or a thin stem for a cup."""
    thin = THIN / 2
    if isinstance(gripper, SuctionGripper):
        return _joined([_box((-thin, -thin, -gripper.cup_length), (thin, thin, 0.0))])
    half = min(width, gripper.max_opening) / 2 + thin
    tip = gripper.tip_beyond_tcp
    back = tip - gripper.finger_length
    bars = [_box((-thin, -half, back - THIN), (thin, half, back))]
    bars += [_box((-thin, y - thin, back), (thin, y + thin, tip)) for y in (-half, half)]
    return _joined(bars)


def _fingers(gripper: ParallelGripper, width: float) -> list[Mesh]:
    tip = gripper.tip_beyond_tcp
    front = tip - gripper.finger_length
    boxes = [_palm(gripper.palm_size, front)]
    for side in (-1, 1):
        inner, outer = side * width / 2, side * (width / 2 + gripper.finger_thickness)
        low, high = sorted((inner, outer))
        half = gripper.finger_width / 2
        boxes.append(_box((-half, low, front), (half, high, tip)))
    return boxes


def _cup(gripper: SuctionGripper) -> list[Mesh]:
    turn = np.linspace(0, 2 * np.pi, SEGMENTS, endpoint=False)
    lip = gripper.cup_diameter / 2
    rings = [
        np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.full(SEGMENTS, z)])
        for radius, z in ((0.6 * lip, -gripper.cup_length), (lip, 0.0))
    ]
    a = np.arange(SEGMENTS)
    b = (a + 1) % SEGMENTS
    wall = np.concatenate(
        [np.column_stack([a, b, b + SEGMENTS]), np.column_stack([a, b + SEGMENTS, a + SEGMENTS])]
    )
    inside = wall[:, ::-1]
    cup = np.concatenate(rings), np.concatenate([wall, inside]).astype(np.int32)
    return [_palm(gripper.palm_size, -gripper.cup_length), cup]


def _palm(size: tuple[float, float, float], front: float) -> Mesh:
    x, y, z = size
    return _box((-x / 2, -y / 2, front - z), (x / 2, y / 2, front))


def _box(low: tuple[float, float, float], high: tuple[float, float, float]) -> Mesh:
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    vertices = np.where(corners == 0, low, high).astype(float)
    faces = [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5]),  # x
        *([0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6]),  # y
        *([0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),  # z
    ]
    return vertices, np.array(faces, dtype=np.int32)


def _joined(meshes: list[Mesh]) -> Mesh:
    before = np.cumsum([0, *(len(vertices) for vertices, _ in meshes[:-1])])
    return (
        np.concatenate([vertices for vertices, _ in meshes]),
        np.concatenate([faces + k for (_, faces), k in zip(meshes, before, strict=True)]).astype(
            np.int32
        ),
    )
