"""The two clients are the same but for `await`."""

from __future__ import annotations

import inspect

import pytest

from shared.client import AsyncSparge, Sparge

METHODS = [name for name, _ in inspect.getmembers(Sparge, inspect.isfunction) if name[0] != "_"]


@pytest.mark.parametrize("name", METHODS)
def test_each_method_has_the_same_signature(name: str) -> None:
    awaited = getattr(AsyncSparge, name)
    assert inspect.iscoroutinefunction(awaited)
    assert inspect.signature(awaited) == inspect.signature(getattr(Sparge, name))


def test_neither_has_a_method_more() -> None:
    there = [
        name for name, _ in inspect.getmembers(AsyncSparge, inspect.isfunction) if name[0] != "_"
    ]
    assert there == METHODS
