"""Whether a part may stand on the support plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.fitting.reach import Reach
from services.primitive_recovery.fitting.terms import support_row
from shared.schemas.scene import SupportPlane

Array = NDArray[np.float64]

GAP = 4.0
"""How many times as high as a ball's lowest visible point a part's may be, if it stands."""
TOUCH = 4.0
"""In tolerances: what is closer to the plane is on it."""

_DOWNWARD = -0.3


@dataclass(frozen=True)
class Contact:
    """The support plane in the unit of the fit.

    Attributes
    ----------
    normal : (3,) array
    reach : float
        How far the plane is along minus the normal.
    tolerance : float
    possible : bool
        Whether the part may stand on it.
    """

    normal: Array
    reach: float
    tolerance: float
    possible: bool

    def touched_by(self, shape: Array, rotation: Array, position: Array) -> bool:
        """Return whether a body, in the unit of the fit, ends at the plane."""
        reach = support_row(-self.normal, shape, rotation, position, np.empty(11))
        return self.possible and abs(reach - self.reach) < TOUCH * self.tolerance


def support_contact(
    points: Array,
    plane: SupportPlane,
    viewpoint: Array,
    reach: Reach,
    centre: Array,
    scale: float,
) -> Contact:
    """Return the contact of points (n, 3) with a plane.

    A ball of height T on the plane, seen from an elevation a, shows itself down to
    T (1 - cos a) / 2: by that much of what it shows, times (1 - cos a) / (1 + cos a), it
    seems to float. What seems to float by much more does, unless something hides its
    lower border.
    """
    outline = reach.outline
    normal = np.array(plane.normal)
    noise = plane.residual_mm / 1e3
    height = np.sort(points @ normal + plane.offset)
    low, high = float(height[len(height) // 200]), float(height[-1 - len(height) // 50])
    to_sensor = viewpoint - centre
    sine = float(np.clip(to_sensor @ normal / np.linalg.norm(to_sensor), 0.0, 1.0))
    cosine = float(np.sqrt(1 - sine**2))
    lift = (1 - cosine) / (1 + cosine) * min(high - low, outline.width)
    possible = low < GAP * lift + 3 * noise + outline.spacing
    hidden = bool(reach.hidden[outline.normals @ normal < _DOWNWARD].any())
    return Contact(
        normal,
        (plane.offset + float(normal @ centre)) / scale,
        max(0.3 * noise / scale, 0.02 * float(height[-1]) / scale, 1e-3),
        possible or hidden,
    )
