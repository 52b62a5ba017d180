"""Which way is up when no support plane was seen."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.perception.observation import Observation

Array = NDArray[np.float64]

_CAMERA_UP = np.array([0.0, -1.0, -1.0]) / np.sqrt(2.0)
_WORLD_UP = np.array([0.0, 0.0, 1.0])


def guess_up(view: Observation) -> Array:
    """Return a unit vector (3,) against gravity.

    With the sensor at the origin the frame is taken for the sensor's own optical frame:
    y down the image, z ahead. A head camera that looks straight ahead has gravity along
    +y, one that looks straight down along +z; halfway, 45 degrees down, is at most 45
    degrees wrong for either. With the sensor elsewhere the frame is a fixed one, where z
    is up (ROS REP 103).
    """
    return _WORLD_UP if view.viewpoint.any() else _CAMERA_UP
