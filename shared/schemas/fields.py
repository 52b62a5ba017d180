"""Field types that several messages share."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Len
from numpy.typing import NDArray
from pydantic import Field, FiniteFloat, StringConstraints

from shared.wire import ArrayField

Points = Annotated[NDArray[np.float64], ArrayField("float64", ("N", 3))]
"""Points in metres; a message may hold several sets of different length."""
Mask = Annotated[NDArray[np.bool_], ArrayField("bool", ("N",))]
Indices = Annotated[NDArray[np.int32], ArrayField("int32", ("N",))]
Labels = Annotated[NDArray[np.int16], ArrayField("int16", ("N",))]
GraspRows = Annotated[NDArray[np.float64], ArrayField("float64", ("G", 9))]
"""x y z qx qy qz qw width score, best first."""

Vector3 = tuple[FiniteFloat, FiniteFloat, FiniteFloat]
Quaternion = tuple[FiniteFloat, FiniteFloat, FiniteFloat, FiniteFloat]
"""[x, y, z, w]"""
SuperquadricVector = Annotated[tuple[FiniteFloat, ...], Len(12, 12)]
"""[e1, e2, a1, a2, a3, tx, ty, tz, qx, qy, qz, qw]"""
Name = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]{0,63}$")]
"""Of a task, an affordance, a gripper."""
TaskText = Annotated[
    str, StringConstraints(strip_whitespace=True, to_lower=True, min_length=1, max_length=64)
]
"""A task as people type it; case and surrounding spaces do not matter."""
