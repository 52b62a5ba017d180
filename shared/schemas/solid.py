"""Where an object's mass is, as far as one view tells."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from pydantic import Field

from shared.schemas.fields import Vector3
from shared.schemas.primitive import Primitive
from shared.superquadric import volume
from shared.wire import Message


class Solid(Message):
    """What an object fills, were it of one material throughout."""

    centre: Vector3
    """Centre of its volume, metres, in the frame of its points."""
    volume: Annotated[float, Field(gt=0, allow_inf_nan=False)]
    """Cubic metres."""

    @classmethod
    def of(cls, primitives: Sequence[Primitive]) -> Solid | None:
        """Return the solid of an object's primitives; None without any.

        They also fill what the sensor did not see: the mean of the visible points lies nearer
        to the sensor than the centre of mass.
        """
        bodies = [primitive.superquadric for primitive in primitives]
        volumes = np.array([volume(body) for body in bodies])
        if not volumes.sum() > 0:
            return None
        x, y, z = volumes @ np.array([body.position for body in bodies]) / volumes.sum()
        return cls(centre=(float(x), float(y), float(z)), volume=float(volumes.sum()))
