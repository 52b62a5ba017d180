"""Principal axes of many small scatter matrices."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]

_SWEEPS = 12


@kernel
def principal_frames(scatters: Array) -> tuple[Array, Array]:
    """Return eigenvalues (G, 3), ascending, and eigenvectors (G, 3, 3) as columns.

    Of symmetric matrices (G, 3, 3); for many of them several times as fast as `eigh`.
    """
    values, vectors = np.empty((len(scatters), 3)), np.empty((len(scatters), 3, 3))
    a, v = np.empty((3, 3)), np.empty((3, 3))
    for g in range(len(scatters)):
        a[:], v[:] = scatters[g], 0.0
        v[0, 0] = v[1, 1] = v[2, 2] = 1.0
        _diagonalise(a, v)
        _sort_axes(a, v, values[g], vectors[g])
    return values, vectors


@kernel
def _diagonalise(a: Array, v: Array) -> None:
    """Turn `a` (3, 3) until it is diagonal, and the axes `v` (3, 3) with it.

    By cyclic Jacobi rotations (Golub and Van Loan, Matrix Computations, section 8.5).
    """
    for _ in range(_SWEEPS):
        off = abs(a[0, 1]) + abs(a[0, 2]) + abs(a[1, 2])
        if off <= 1e-15 * (abs(a[0, 0]) + abs(a[1, 1]) + abs(a[2, 2])):
            break
        for p in range(2):
            for q in range(p + 1, 3):
                if a[p, q] == 0.0:
                    continue
                theta = (a[q, q] - a[p, p]) / (2.0 * a[p, q])
                t = 1.0 / (abs(theta) + np.sqrt(theta * theta + 1.0))
                if theta < 0.0:
                    t = -t
                c = 1.0 / np.sqrt(t * t + 1.0)
                s = t * c
                for k in range(3):
                    a[k, p], a[k, q] = c * a[k, p] - s * a[k, q], s * a[k, p] + c * a[k, q]
                for k in range(3):
                    a[p, k], a[q, k] = c * a[p, k] - s * a[q, k], s * a[p, k] + c * a[q, k]
                for k in range(3):
                    v[k, p], v[k, q] = c * v[k, p] - s * v[k, q], s * v[k, p] + c * v[k, q]


@kernel
def _sort_axes(a: Array, v: Array, values: Array, vectors: Array) -> None:
    """Write the diagonal of `a`, ascending, and the columns of `v` in the same order."""
    first, last = 0, 0
    for k in range(1, 3):
        if a[k, k] < a[first, first]:
            first = k
        if a[k, k] >= a[last, last]:
            last = k
    if first == last:  # all are equal
        first, last = 0, 2
    order = (first, 3 - first - last, last)
    for k in range(3):
        values[k] = a[order[k], order[k]]
        vectors[:, k] = v[:, order[k]]
