"""What both halves of matching ask of their arrays."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.errors import InvalidInput

_LARGEST = 1e6


def check_finite(name: str, array: NDArray[np.float64]) -> None:
    """Raise `InvalidInput` unless all values are finite and below a million in size."""
    if not np.isfinite(array).all():
        raise InvalidInput(f"{name} must be finite", field=name, allowed="finite numbers")
    if array.size and (largest := float(np.abs(array).max())) > _LARGEST:
        raise InvalidInput(
            f"{name} holds {largest:.3g}; are these metres?",
            field=name,
            found=largest,
            allowed=_LARGEST,
        )
