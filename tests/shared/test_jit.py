"""Kernels compile with and without a cache on disk, for one type of array."""

from __future__ import annotations

import ast
import importlib
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from shared.jit import kernel, kernels_on_disk, read_only
from shared.settings import PROJECT_ROOT

SORTING = {"sort", "argsort", "median", "nanmedian", "percentile", "quantile", "partition"}


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


def test_no_kernel_sorts_by_numpy() -> None:
    """What numba makes of it has names that repeat from process to process (see `kernel`)."""
    kernels = [*_kernels()]
    assert len(kernels) > 100
    assert [name for name, function in kernels if _called(function) & SORTING] == []
    (snippet,) = ast.parse("def f(x):\n    return np.sort(x)[0] + x.argsort()[0]").body
    assert _called(snippet) == {"sort", "argsort"}


def _kernels() -> Iterator[tuple[str, ast.stmt]]:
    for folder in ("services", "shared"):
        for path in sorted((PROJECT_ROOT / folder).rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.FunctionDef) and any(
                    isinstance(each, ast.Name) and each.id == "kernel"
                    for each in node.decorator_list
                ):
                    yield f"{path.relative_to(PROJECT_ROOT)}:{node.name}", node


def _called(function: ast.AST) -> set[str]:
    return {
        node.func.attr
        for node in ast.walk(function)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)
    }
