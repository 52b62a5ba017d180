"""From the certainty of a proof to the probability that its region is right."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path

MAPS = Path(__file__).parent / "model" / "confidence.json"
"""The shipped maps; `confidence_card.md` beside it says on what they were fitted."""

_LEAST = 1e-4


@dataclass(frozen=True)
class Map:
    """Platt scaling, 1 / (1 + exp(-(offset + slope logit c))); Platt (1999).

    Attributes
    ----------
    offset, slope : float
        With slope > 0 the map rises strictly, so no order of regions changes.
    """

    offset: float = 0.0
    slope: float = 1.0

    def __call__(self, certainty: float) -> float:
        """Return the confidence for a certainty, both 0 to 1."""
        return 1 / (1 + math.exp(-(self.offset + self.slope * logit(certainty))))


def logit(certainty: float) -> float:
    """Return log(c / (1 - c)) of a certainty kept off 0 and 1 by 1e-4."""
    kept = min(max(certainty, _LEAST), 1 - _LEAST)
    return math.log(kept / (1 - kept))


def read_maps(file: Path) -> dict[str, Map]:
    """Return the map of each rule set that has one.

    Raises
    ------
    ValueError
        A slope that does not rise.
    """
    held = json.loads(file.read_text())
    maps = {rule_set: Map(each["offset"], each["slope"]) for rule_set, each in held.items()}
    for rule_set, each in maps.items():
        if not each.slope > 0:
            raise ValueError(f"{file}: the map of {rule_set} must rise, its slope is {each.slope}")
    return maps
