"""Kernels compile with and without a cache on disk, for one type of array."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from shared.jit import kernel, read_only


def test_a_function_that_cannot_be_cached_works_all_the_same() -> None:
    # Code without a file has nowhere to keep its cache: numba refuses to cache it.
    scope: dict[str, Callable[[float], float]] = {}
    exec("def twice(x):\n    return 2.0 * x", scope)
    assert kernel(scope["twice"])(4.0) == 8.0


def test_read_only_makes_one_type_of_all_arrays() -> None:
    writable = np.ones((4, 3))
    frozen = np.ones((4, 3))
    frozen.flags.writeable = False
    for array in (writable, frozen, writable[::2], writable.astype(np.float32), writable.T):
        given = read_only(array)
        assert given.dtype == np.float64
        assert given.flags.c_contiguous
        assert not given.flags.writeable
        np.testing.assert_array_equal(given, array)
    assert writable.flags.writeable
