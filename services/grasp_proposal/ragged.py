"""Rows of different length as one table."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def padded_columns(
    chosen: NDArray[np.bool_], filler: int = 0
) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Return the chosen columns of each row, padded to the longest row.

    Parameters
    ----------
    chosen : (R, C) bool array
    filler : int
        Stands where a row has no more columns.

    Returns
    -------
    columns : (R, n) int array, n >= 1
    filled : (R, n) bool array
        False where `columns` holds the filler.
    """
    counts = chosen.sum(axis=1)
    rows, columns = np.nonzero(chosen)
    place = np.arange(len(rows)) - np.repeat(np.cumsum(counts) - counts, counts)
    table = np.full((len(chosen), max(1, int(counts.max(initial=0)))), filler, dtype=np.intp)
    table[rows, place] = columns
    return table, np.arange(table.shape[1]) < counts[:, None]
