"""Superquadrics that people labelled, from a file of the user's: a test, never training."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from experiments.shapes.criterion import CLASSES
from shared.errors import InvalidInput, NotFound

Array = NDArray[np.float64]
Labels = NDArray[np.int64]


def human_labels(path: Path) -> tuple[Array, Labels]:
    """Read a CSV of e1, e2, a1, a2, a3, class (0 cuboid, 1 cylinder, 2 sphere).

    The first line holds headings. Exponents lie in 0..2, sizes are in any unit.

    Returns
    -------
    parameters : (N, 5) array
    classes : (N,) array

    Raises
    ------
    NotFound
        There is no such file.
    InvalidInput
        It is not such a table.
    """
    if not path.is_file():
        raise NotFound(f"there is no file {path}")
    try:
        lines = [line for line in path.read_text("utf-8").splitlines()[1:] if line.strip()]
        table = np.loadtxt(lines, delimiter=",", ndmin=2) if lines else np.empty((0, 0))
    except ValueError as error:
        raise InvalidInput(f"{path} is no table of numbers: {error}") from None
    if table.shape[1] != 6:
        raise InvalidInput(f"{path} needs lines of e1, e2, a1, a2, a3, class")
    if not np.isfinite(table).all() or (table[:, :5] <= 0).any() or (table[:, :2] > 2).any():
        raise InvalidInput(f"{path}: exponents must lie in 0..2, sizes must be positive")
    if not np.isin(table[:, 5], range(len(CLASSES))).all():
        raise InvalidInput(f"{path}: the class must be 0 (cuboid), 1 (cylinder) or 2 (sphere)")
    return table[:, :5], table[:, 5].astype(np.int64)
