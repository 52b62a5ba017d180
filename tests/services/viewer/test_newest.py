"""Only the newest work counts."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial

import pytest

from services.viewer.newest import Newest


def test_what_waits_is_dropped_for_what_is_newer() -> None:
    newest, begun, go, done = Newest(), threading.Event(), threading.Event(), threading.Event()
    seen: list[tuple[str, bool]] = []

    def first(is_newest: Callable[[], bool]) -> None:
        begun.set()
        go.wait(10)
        seen.append(("first", is_newest()))

    newest.submit(first)
    assert begun.wait(10)

    def later(name: str, is_newest: Callable[[], bool]) -> None:
        seen.append((name, is_newest()))
        done.set()

    newest.submit(partial(later, "second"))
    newest.submit(partial(later, "third"))
    go.set()
    assert done.wait(10)
    assert seen == [("first", False), ("third", True)]
    newest.close()


def test_a_failure_is_logged_and_the_next_is_done(caplog: pytest.LogCaptureFixture) -> None:
    newest, done = Newest(), threading.Event()

    def fail(_: object) -> None:
        raise ZeroDivisionError

    newest.submit(fail)
    while not caplog.records:
        threading.Event().wait(0.01)
    newest.submit(lambda _: done.set())
    assert done.wait(10)
    newest.close()
