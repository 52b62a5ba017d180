"""Compile numeric kernels with numba, cached on disk where a disk can be written."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numba

Function = TypeVar("Function", bound=Callable[..., object])


def kernel(function: Function) -> Function:
    """Mark a function on plain arrays for compilation at its first call.

    The machine code is cached beside the module, in NUMBA_CACHE_DIR, or in the
    user's cache folder; where none of them can be written, it is compiled anew
    by each process. Call a kernel with one combination of argument types only:
    processes that start together share the cache, and numba's index of it is
    safe against that only as long as all of them write the same entry.
    """
    try:
        compiled: Function = numba.njit(cache=True, error_model="numpy")(function)
    except RuntimeError:  # "no locator available": nowhere to write
        compiled = numba.njit(error_model="numpy")(function)
    return compiled
