"""A parallel gripper seen along its x axis, in the plane of closing and approach."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon
from numpy.typing import ArrayLike, NDArray

from shared.grippers.kinematics import choose_link, tcp_from_link
from shared.schemas.gripper import ParallelGripper

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Hand:
    """A gripper with its tool centre point somewhere in the drawing.

    Attributes
    ----------
    gripper : ParallelGripper
    opening : float
        Between the pads, metres.
    tcp : (2,) array_like
        Where the tool centre point is on the page.
    approach : (2,) array_like
        Unit vector of +z on the page; +y is to its left where +z points down.
    """

    gripper: ParallelGripper
    opening: float
    tcp: ArrayLike = (0.0, 0.0)
    approach: ArrayLike = (0.0, -1.0)

    def place(self, yz: ArrayLike) -> Array:
        """Return points (N, 2) of the y-z plane of the grasp frame on the page."""
        z = np.asarray(self.approach, dtype=np.float64)
        y = np.array([-z[1], z[0]])
        points = np.asarray(yz, dtype=np.float64)
        return np.asarray(np.asarray(self.tcp) + points[..., :1] * y + points[..., 1:] * z)

    @property
    def base(self) -> float:
        """Where the link that it hangs on is along z: behind the TCP, so negative."""
        link = choose_link(self.gripper, None)
        return float(tcp_from_link(self.gripper, link, self.opening)[2, 3])

    @property
    def tip(self) -> float:
        return self.gripper.tip_beyond_tcp

    def draw(self, ax: Axes, *, palm: bool = True, **style: Any) -> None:
        """Draw fingers and palm as the boxes of the gripper's file."""
        looks: dict[str, Any] = {"facecolor": "#d9dde3", "edgecolor": "#4a5560", "lw": 1.2, **style}
        front = self.base + self.gripper.palm_size[2]
        inner, thick = self.opening / 2, self.gripper.finger_thickness
        boxes = [(side * inner, side * (inner + thick), front, self.tip) for side in (-1.0, 1.0)]
        if palm:
            half = self.gripper.palm_size[1] / 2
            boxes.append((-half, half, self.base, front))
        for left, right, back, end in boxes:
            corners = [(left, back), (right, back), (right, end), (left, end)]
            ax.add_patch(Polygon(self.place(corners), closed=True, **looks))
