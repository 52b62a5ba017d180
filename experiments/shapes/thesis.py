"""Table A.2 of the thesis, as printed."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

TABLE_A_2: Mapping[str, tuple[float, float, float, float, float]] = MappingProxyType(
    {
        "heuristic": (0.84, 0.77, 0.82, 0.78, 0.73),
        "random forest": (1.00, 0.93, 0.93, 0.89, 0.91),
        "SVM": (0.96, 0.93, 0.93, 0.92, 0.92),
        "MLP": (1.00, 0.94, 0.95, 0.92, 0.93),
    }
)
"""Method -> train accuracy, test accuracy, precision, recall, F1 (the last three macro)."""

TRAIN = 412
"""Its training samples; 138 more were its test."""
