"""Field types that several messages share."""

from __future__ import annotations

import math
from typing import Annotated, TypeVar

import numpy as np
from annotated_types import Len
from numpy.typing import NDArray
from pydantic import AfterValidator, Field, FiniteFloat, StringConstraints

from shared.wire import ArrayField

_V = TypeVar("_V", bound=tuple[float, ...])


def _points_somewhere(vector: _V) -> _V:
    length = math.hypot(*vector)
    if not 1e-6 < length < 1e6:
        raise ValueError(f"must have a direction, its length is {length:g}")
    return vector


Points = Annotated[NDArray[np.float64], ArrayField("float64", ("N", 3))]
"""Points in metres; a message may hold several sets of different length."""
Mask = Annotated[NDArray[np.bool_], ArrayField("bool", ("N",))]
Indices = Annotated[NDArray[np.int32], ArrayField("int32", ("N",))]
Labels = Annotated[NDArray[np.int16], ArrayField("int16", ("N",))]
SuperquadricRows = Annotated[NDArray[np.float64], ArrayField("float64", ("P", 12))]
"""Rows `[e1, e2, a1, a2, a3, tx, ty, tz, qx, qy, qz, qw]`, metres."""
GraspRows = Annotated[NDArray[np.float64], ArrayField("float64", ("G", 9))]
"""x y z qx qy qz qw width score, best first."""

HeldShares = Annotated[NDArray[np.float64], ArrayField("float64", ("G", 3))]
"""For each grasp the share in [0, 1] of what it holds that lies in a region: of all points between
the pads, of those that the left pad touches, and the right one."""

FARTHEST_M = 1e6
"""What is farther away is no place that a robot sees; its square would still be exact enough."""
Metres = Annotated[FiniteFloat, Field(ge=-FARTHEST_M, le=FARTHEST_M)]
"""A coordinate or a distance."""
Vector3 = tuple[Metres, Metres, Metres]
Direction = Annotated[
    tuple[FiniteFloat, FiniteFloat, FiniteFloat], AfterValidator(_points_somewhere)
]
"""A vector that points somewhere."""
Quaternion = Annotated[
    tuple[FiniteFloat, FiniteFloat, FiniteFloat, FiniteFloat], AfterValidator(_points_somewhere)
]
"""[x, y, z, w]"""
SuperquadricVector = Annotated[tuple[FiniteFloat, ...], Len(12, 12)]
"""[e1, e2, a1, a2, a3, tx, ty, tz, qx, qy, qz, qw]"""
Name = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]{0,63}$")]
"""Of a task, an affordance, a gripper."""
TaskText = Annotated[
    str, StringConstraints(strip_whitespace=True, to_lower=True, min_length=1, max_length=64)
]
"""A task as people type it; case and surrounding spaces do not matter."""
