"""What the fit of one part returns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shared.schemas.primitive import Deformation
from shared.superquadric import Superquadric


@dataclass(frozen=True)
class PartFit:
    """The superquadric of one part.

    Attributes
    ----------
    superquadric : Superquadric
        The whole part, seen and unseen, in the frame of the points, metres.
    covariance : (11, 11) array
        Of e1, e2, a1, a2, a3 (metres), tx, ty, tz (metres, frame of the points)
        and a rotation vector in the superquadric's own frame (radians).
    residual : float
        Root mean square radial distance of the points, metres.
    deformation : Deformation or None
        Taper and bend, where they explain the points better by the Bayesian
        information criterion; the superquadric is the one without them.
    rests : bool
        Whether it may stand on the support plane and ends there.
    """

    superquadric: Superquadric
    covariance: NDArray[np.float64]
    residual: float
    deformation: Deformation | None
    rests: bool
