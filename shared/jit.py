"""Compile numeric kernels with numba, cached on disk where a disk can be written.

Only services whose group in pyproject.toml names numba may import this.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba
import numpy as np
from numpy.typing import NDArray

Function = TypeVar("Function", bound=Callable[..., object])
Array = NDArray[np.float64]

_kernels: list[Any] = []


def kernel(function: Function) -> Function:
    """Mark a function on plain arrays for compilation at its first call.

    It runs without the interpreter's lock, so requests overlap. The machine code is
    cached beside the module, in NUMBA_CACHE_DIR, or in the user's cache folder; where
    none of them can be written, it is compiled anew by each process. Call a kernel with
    one combination of argument types only (a read-only array is another type than a
    writable one): processes that start together share the cache, and numba's index of it
    is safe against that only as long as all of them write the same entry. The cache
    notices changes in the file of the function alone, so kernels that call each other
    belong in one file. Leave NumPy's sorting (sort, argsort, median, percentile) out of
    them: numba builds it from inner functions whose compiled names repeat from process to
    process, and pieces cached by two processes can be linked into each other;
    `shared.sorting` has kernels that sort.
    """
    options = {"error_model": "numpy", "nogil": True}
    try:
        compiled: Function = numba.njit(cache=True, **options)(function)
    except RuntimeError:  # "no locator available": nowhere to write
        compiled = numba.njit(**options)(function)
    _kernels.append(compiled)
    return compiled


def types_compiled() -> dict[str, int]:
    """Return for how many combinations of argument types each kernel so far was compiled."""
    return {
        f"{each.py_func.__module__}.{each.py_func.__name__}": len(each.signatures)
        for each in _kernels
    }


def kernels_on_disk() -> dict[str, bool | None]:
    """Return whether each kernel so far is cached on disk; None where no disk can be written.

    What is cached may be of another processor; it is then compiled once more.
    """
    found: dict[str, bool | None] = {}
    for each in _kernels:
        function, folder = each.py_func, each.stats.cache_path
        pattern = f"*.{function.__qualname__}-{function.__code__.co_firstlineno}.*.nbi"
        found[f"{function.__module__}.{function.__name__}"] = (
            None if folder is None else any(Path(folder).glob(pattern))
        )
    return found


def read_only(array: NDArray[np.generic]) -> Array:
    """Return `array` as a read-only, C-contiguous float64 array: one type for a kernel."""
    held = np.ascontiguousarray(array, dtype=np.float64).view()
    held.flags.writeable = False
    return held
