"""Kernels compile with and without a cache on disk, for one type of array."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from shared.jit import kernel, kernels_on_disk, read_only


def test_a_function_that_cannot_be_cached_works_all_the_same() -> None:
    # Code without a file has nowhere to keep its cache: numba refuses to cache it.
    scope: dict[str, Callable[[float], float]] = {}
    exec("def twice(x):\n    return 2.0 * x", scope)
    assert kernel(scope["twice"])(4.0) == 8.0


def test_kernels_know_whether_they_are_on_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("shared.jit._kernels", [])
    scope: dict[str, Callable[[float], float]] = {}
    exec("def nowhere(x):\n    return x", scope)
    kernel(scope["nowhere"])
    (tmp_path / "module_on_disk.py").write_text("def thrice(x):\n    return 3.0 * x\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr("numba.config.CACHE_DIR", str(tmp_path / "cache"))
    thrice = kernel(importlib.import_module("module_on_disk").thrice)
    assert [*kernels_on_disk().values()] == [None, False]
    thrice(2.0)
    assert [*kernels_on_disk().values()] == [None, True]


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
