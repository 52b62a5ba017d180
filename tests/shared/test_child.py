from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator

import pytest

from shared.child import Child, ChildEnded, ChildTooSlow
from shared.errors import InternalError, UnknownGripper


@pytest.fixture
def child() -> Iterator[Child]:
    started = Child("tests.support.odd_child", environment=dict(os.environ))
    yield started
    started.stop()


def test_frames_go_there_and_back(child: Child) -> None:
    for frame in (b"", b"x", bytes(range(256)) * 2**14):
        assert child.ask(frame, limit_s=20) == [frame, b"", frame]


def test_an_error_comes_back_as_itself_and_the_next_is_answered(child: Child) -> None:
    with pytest.raises(UnknownGripper) as caught:
        child.ask(b"refuse", limit_s=20)
    assert caught.value.details == {"found": "soft"}
    assert child.ask(b"x", limit_s=20)


def test_a_fault_is_in_the_log_here_and_not_in_the_answer(
    child: Child, caplog: pytest.LogCaptureFixture
) -> None:
    with pytest.raises(InternalError) as caught:
        child.ask(b"fault", limit_s=20)
    assert "ZeroDivisionError" not in str(caught.value.envelope(""))
    (record,) = caplog.records
    assert "ZeroDivisionError: a fault of ours" in record.getMessage()


def test_a_crash_is_told_with_its_signal(child: Child) -> None:
    with pytest.raises(ChildEnded) as caught:
        child.ask(b"crash", limit_s=20)
    assert caught.value.exit_status == -signal.SIGSEGV
    assert not child.alive


def test_who_takes_too_long_is_ended(child: Child) -> None:
    started = time.monotonic()
    with pytest.raises(ChildTooSlow):
        child.ask(b"hang", limit_s=0.3)
    assert time.monotonic() - started < 10


def test_what_does_not_start_is_told() -> None:
    with pytest.raises(ChildEnded):
        Child("tests.support.no_such_module", environment=dict(os.environ))


def test_no_memory_is_taken_for_what_it_boasts_of() -> None:
    boaster = Child("tests.support.odd_child", "boast", environment=dict(os.environ))
    with pytest.raises(ChildEnded):
        boaster.ask(b"x", limit_s=60, max_answer_bytes=2**20)
    assert not boaster.alive
