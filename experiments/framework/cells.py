"""What stands in a cell of a table: a text for people, plain numbers for programs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Self

import numpy as np

Z_95 = 1.959963984540054
"""Two-sided 95 % quantile of the normal distribution."""


@dataclass(frozen=True)
class Share:
    """How many of how many.

    Raises
    ------
    ValueError
        `count` is not within 0..total.
    """

    count: int
    total: int

    def __post_init__(self) -> None:
        if not 0 <= self.count <= self.total:
            raise ValueError(f"{self.count} of {self.total} is no share")

    @classmethod
    def of(cls, answers: Iterable[bool]) -> Self:
        """Return the share that is true."""
        held = [bool(each) for each in answers]
        return cls(sum(held), len(held))

    @property
    def value(self) -> float:
        """The share itself; nan of nothing."""
        return self.count / self.total if self.total else math.nan

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % Wilson score interval (Wilson 1927); all of [0, 1] of nothing."""
        if not self.total:
            return 0.0, 1.0
        n, z2 = self.total, Z_95**2
        middle = (self.value + z2 / (2 * n)) / (1 + z2 / n)
        half = Z_95 / (1 + z2 / n) * math.sqrt(self.value * (1 - self.value) / n + z2 / (4 * n * n))
        # Rounding must not push a bound past the share itself.
        return (
            max(0.0, min(middle - half, self.value)),
            min(1.0, max(middle + half, self.value)),
        )

    def brief(self) -> str:
        """Return `12/30`."""
        return f"{self.count}/{self.total}" if self.total else "–"

    def text(self) -> str:
        """Return `12/30 (40 %, 25-58)`: the share and its interval in percent."""
        if not self.total:
            return "–"
        low, high = (f"{100 * bound:.0f}" for bound in self.interval)
        return f"{self.count}/{self.total} ({100 * self.value:.0f} %, {low}–{high})"

    def fields(self) -> Mapping[str, float | int]:
        """Return the numbers."""
        low, high = self.interval
        return {"count": self.count, "total": self.total, "low": low, "high": high}


@dataclass(frozen=True)
class MeanStd:
    """Mean and standard deviation of a sample, times `scale` when shown."""

    mean: float
    std: float
    count: int
    digits: int = 2

    @classmethod
    def of(cls, values: Iterable[float | None], digits: int = 2) -> Self:
        """Return both over the values that are there; nan of none, std 0 of one."""
        held = np.array([each for each in values if each is not None], dtype=np.float64)
        if not len(held):
            return cls(math.nan, math.nan, 0, digits)
        std = float(held.std(ddof=1)) if len(held) > 1 else 0.0
        return cls(float(held.mean()), std, len(held), digits)

    def brief(self) -> str:
        """Return `0.81±0.12`."""
        return self.text().replace(" ", "")

    def text(self) -> str:
        """Return `0.81 ± 0.12`."""
        if not self.count:
            return "–"
        return f"{self.mean:.{self.digits}f} ± {self.std:.{self.digits}f}"

    def fields(self) -> Mapping[str, float | int]:
        """Return the numbers."""
        return {"mean": self.mean, "std": self.std, "n": self.count}


Cell = str | int | float | bool | None | Share | MeanStd


def text_of(cell: Cell, *, brief: bool = False) -> str:
    """Return what people read; `brief` leaves out the intervals."""
    if isinstance(cell, Share | MeanStd):
        return cell.brief() if brief else cell.text()
    if cell is None or (isinstance(cell, float) and math.isnan(cell)):
        return "–"
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    if isinstance(cell, float):
        return f"{cell:.3g}" if abs(cell) < 10 else f"{cell:.1f}"
    return str(cell)


def fields_of(column: str, cell: Cell) -> dict[str, str]:
    """Return what programs read: one or more columns of a CSV file."""
    if isinstance(cell, Share | MeanStd):
        return {f"{column} {name}": _plain(value) for name, value in cell.fields().items()}
    return {column: _plain(cell)}


def _plain(value: str | float | int | bool | None) -> str:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:.6g}" if isinstance(value, float) else str(value)
