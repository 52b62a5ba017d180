"""The page's world, and from where it is looked at first.

A page turns about the vertical, so its world has z against gravity. The frame of a view has it
anywhere: a camera's y mostly points down.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shared.geometry.points import bounds
from shared.geometry.rotation import frame_from_z, unit
from shared.geometry.se3 import inverse, pose_matrix

Array = NDArray[np.float64]

ELEVATION_DEG = 30.0
AZIMUTHS_DEG = (-35.0, 35.0, -65.0, 65.0, -10.0, 10.0)
"""About the vertical, from the sensor's side; of these the one that shows most of the object."""
FIELD_OF_VIEW_DEG = 40.0
DISTANCE = 2.6
"""Of the eye from the middle, in radii of the object and its gripper."""
GRIPPER_M = 0.05
NOWHERE = np.array([[0.0, 0.0, 0.5]])


@dataclass(frozen=True)
class Stage:
    """The world of a page about one object.

    Attributes
    ----------
    world_from_view : (4, 4) array
        The world's origin is under the middle of the object, z against gravity, x away from the
        sensor; metres.
    eye, look_at : (3,) arrays
        From where to look, and where to, in the world.
    field_of_view : float
        Of the picture's height, radians.
    """

    world_from_view: Array
    eye: Array
    look_at: Array
    field_of_view: float = float(np.deg2rad(FIELD_OF_VIEW_DEG))

    @classmethod
    def of(
        cls, points: Array, up: ArrayLike, viewpoint: ArrayLike, palm: ArrayLike = (0.0, 0.0, 0.0)
    ) -> Stage:
        """Return the stage of an object.

        Parameters
        ----------
        points : (N, 3) array
            The object's, in the view's frame, metres.
        up : (3,) array_like
            Against gravity, in the view's frame.
        viewpoint : (3,) array_like
            Position of the sensor, in the view's frame.
        palm : (3,) array_like
            Direction from what is held to the palm, in the view's frame, which had better not be
            towards the eye; zero: there is no hand.
        """
        held = points[np.isfinite(points).all(axis=1)]
        held = held if len(held) else NOWHERE
        z = unit(up) if np.linalg.norm(up) > 0 else np.array([0.0, 0.0, 1.0])
        low, extents = bounds(held)
        gaze = low + extents / 2 - np.asarray(viewpoint, dtype=float)
        axes = frame_from_z(z, x_hint=gaze)
        low, extents = bounds(held @ axes)
        middle = low + extents / 2
        view_from_world = pose_matrix(axes @ [middle[0], middle[1], low[2]], axes)
        radius = float(np.linalg.norm(extents)) / 2 + GRIPPER_M
        towards = _towards((held @ axes)[:, :2], np.asarray(palm, dtype=float) @ axes)
        look_at = np.array([0.0, 0.0, (extents[2] + GRIPPER_M) / 2])
        return cls(inverse(view_from_world), look_at + DISTANCE * radius * towards, look_at)


def _towards(level: Array, palm: Array) -> Array:
    """Return the direction (3,) to the eye; `level` (N, 2) is the object from above."""
    azimuths, elevation = np.deg2rad(AZIMUTHS_DEG), np.deg2rad(ELEVATION_DEG)
    flat = np.cos(elevation)
    towards = np.column_stack(
        [
            -flat * np.cos(azimuths),
            -flat * np.sin(azimuths),
            np.full(len(azimuths), np.sin(elevation)),
        ]
    )
    across = np.ptp(level @ np.array([np.sin(azimuths), -np.cos(azimuths)]), axis=0)
    hidden = np.maximum(towards @ palm, 0.0)
    best: Array = towards[np.argmax(across * (1 - hidden))]
    return best
