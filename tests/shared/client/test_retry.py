"""What is asked again: the table of docs/client.md, without a clock and over both clients."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from email.utils import format_datetime
from typing import Any

import httpx
import numpy as np
import pytest

from shared.client import RetryPolicy
from shared.client.question import Question, add_task, grasp, routed
from shared.client.retry import Attempts
from shared.errors import (
    Conflict,
    DeadlineExceeded,
    InvalidInput,
    NotStored,
    SpargeError,
    StageUnavailable,
    TooBusy,
    UnknownTask,
)
from shared.schemas.execution import EXECUTE, ExecuteRequest
from shared.schemas.grasp import Pose
from shared.schemas.route import Nothing
from shared.schemas.task import LIST_TASKS
from tests.support.both_clients import of_kind, sending

AT_ONCE = RetryPolicy(attempts=4, backoff_s=0.0, max_backoff_s=0.0)
POINTS = np.zeros((4, 3))
LIFT = ExecuteRequest(
    pose=Pose(position=(0, 0, 0), quaternion=(0, 0, 0, 1)),
    width=0.05,
    primitives=((1, 1, 0.02, 0.02, 0.05, 0, 0, 0, 0, 0, 0, 1),),
    up=(0, 0, 1),
)
PURE: dict[str, Question[Any]] = {
    "a list": routed(LIST_TASKS, Nothing()),
    "a grasp": grasp(POINTS, "pouring", {}),
    "an execution": routed(EXECUTE, LIFT),
}
CHANGE = add_task("watering", "", ["contain"], [], [])


def error_answer(error: SpargeError, retry_after: str | None = "0") -> httpx.Response:
    headers = {} if retry_after is None else {"Retry-After": retry_after}
    return httpx.Response(error.status, json=error.envelope("abc"), headers=headers)


class Clock:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


def attempts(
    question: Question[Any],
    policy: RetryPolicy | None = None,
    timeout_s: float = 60.0,
    clock: Clock | None = None,
) -> Attempts[Any]:
    started = Attempts(
        question, policy or RetryPolicy(), timeout_s, np.random.default_rng(0), clock or Clock()
    )
    started.request()
    return started


BUSY, DOWN = TooBusy("full"), StageUnavailable("down")
RESET, REFUSED = httpx.ReadError("reset"), httpx.ConnectError("refused")
LATE = httpx.ReadTimeout("late")


@pytest.mark.parametrize("question", PURE.values(), ids=PURE)
@pytest.mark.parametrize(
    "outcome",
    [error_answer(BUSY), error_answer(DOWN), RESET, REFUSED, httpx.RemoteProtocolError("cut")],
    ids=str,
)
def test_what_changes_nothing_is_asked_again(question: Question[Any], outcome: Any) -> None:
    assert attempts(question).pause_after(outcome) is not None


@pytest.mark.parametrize("outcome", [error_answer(BUSY), REFUSED, httpx.ConnectTimeout("")])
def test_a_change_that_was_certainly_not_made_is_asked_again(outcome: Any) -> None:
    assert attempts(CHANGE).pause_after(outcome) is not None


@pytest.mark.parametrize("error", [DOWN, NotStored("disk full")])
def test_a_change_that_was_answered_with_503_is_not(error: SpargeError) -> None:
    assert attempts(CHANGE).pause_after(error_answer(error)) is None


@pytest.mark.parametrize("outcome", [RESET, httpx.RemoteProtocolError("cut")])
def test_a_change_whose_answer_was_lost_is_not(outcome: Exception) -> None:
    with pytest.raises(StageUnavailable, match="cannot be reached"):
        attempts(CHANGE).pause_after(outcome)


@pytest.mark.parametrize("question", [*PURE.values(), CHANGE])
@pytest.mark.parametrize("outcome", [LATE, httpx.WriteTimeout(""), TimeoutError()])
def test_what_ran_out_of_time_is_not(question: Question[Any], outcome: Exception) -> None:
    with pytest.raises(DeadlineExceeded, match="within 60 s"):
        attempts(question).pause_after(outcome)


@pytest.mark.parametrize("question", [*PURE.values(), CHANGE])
@pytest.mark.parametrize(
    "error", [UnknownTask("no"), Conflict("no"), InvalidInput("no"), DeadlineExceeded("no")]
)
def test_an_answer_that_would_be_the_same_is_not(
    question: Question[Any], error: SpargeError
) -> None:
    asked = attempts(question)
    answer = error_answer(error)
    assert asked.pause_after(answer) is None
    with pytest.raises(type(error)):
        asked.read(answer)


@pytest.mark.parametrize("error", [BUSY, DOWN])
def test_without_retry_after_nobody_was_invited(error: SpargeError) -> None:
    assert attempts(PURE["a grasp"]).pause_after(error_answer(error, None)) is None


def test_the_pause_is_what_was_said_and_a_random_bit_more() -> None:
    policy = RetryPolicy(backoff_s=0.5)
    pauses = [
        Attempts(PURE["a list"], policy, 60, np.random.default_rng(seed), Clock())
        for seed in range(20)
    ]
    found = []
    for each in pauses:
        each.request()
        found.append(each.pause_after(error_answer(BUSY, "3")))
    assert all(pause is not None and 3 <= pause <= 3.5 for pause in found)
    assert len(set(found)) == len(found)


def test_a_date_says_when_too() -> None:
    when = format_datetime(datetime.now(UTC) + timedelta(seconds=20), usegmt=True)
    pause_s = attempts(PURE["a list"]).pause_after(error_answer(BUSY, when))
    assert pause_s is not None
    assert 18 < pause_s < 21


def test_pauses_grow_up_to_their_bound() -> None:
    policy = RetryPolicy(backoff_s=0.5, max_backoff_s=4.0)
    rng = np.random.default_rng(1)
    longest = [max(policy.backoff(asked, rng) for _ in range(500)) for asked in range(1, 7)]
    assert longest == pytest.approx([0.5, 1, 2, 4, 4, 4], rel=0.05)


def test_after_the_last_attempt_the_error_comes_out() -> None:
    asked = attempts(PURE["a list"], RetryPolicy(attempts=2))
    assert asked.pause_after(REFUSED) is not None
    asked.request()
    with pytest.raises(StageUnavailable, match=r"refused \(asked 2 times\)"):
        asked.pause_after(REFUSED)


def test_nothing_is_waited_for_beyond_the_deadline() -> None:
    asked = attempts(PURE["a list"], timeout_s=5.0)
    assert asked.pause_after(error_answer(BUSY, "30")) is None


def test_every_attempt_says_how_much_time_is_left() -> None:
    clock = Clock()
    asked = attempts(PURE["a list"], timeout_s=10.0, clock=clock)
    clock.now = 6.0
    _, _, options = asked.request()
    assert float(options["headers"]["X-Request-Timeout"]) == pytest.approx(3.75)
    assert options["timeout"].read == pytest.approx(4.0)
    clock.now = 10.5
    with pytest.raises(DeadlineExceeded, match="within 10 s"):
        asked.request()


@pytest.mark.parametrize("wrong", [{"attempts": 0}, {"backoff_s": -1.0}, {"backoff_s": 9.0}])
def test_policies_that_make_no_sense(wrong: dict[str, Any]) -> None:
    with pytest.raises(InvalidInput):
        RetryPolicy(**wrong)


@pytest.fixture(params=["sync", "async"])
def kind(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def served(kind: str, answers: list[Any], seen: list[httpx.Request]) -> Any:
    """Return what sends, answered in turn."""

    def handle(request: httpx.Request) -> httpx.Response:
        seen.append(request)
        outcome = answers[len(seen) - 1]
        if isinstance(outcome, Exception):
            raise outcome
        assert isinstance(outcome, httpx.Response)
        return outcome

    return sending(kind, handle)


TASKS: dict[str, list[str]] = {"tasks": []}


def test_clients_ask_again_until_there_is_an_answer(kind: str) -> None:
    seen: list[httpx.Request] = []
    answers = [REFUSED, error_answer(BUSY), RESET, httpx.Response(200, json=TASKS)]
    with of_kind(kind, served(kind, answers, seen), retries=AT_ONCE) as sparge:
        assert sparge.tasks() == ()
    assert len(seen) == 4
    assert len({request.headers["x-request-id"] for request in seen}) == 1


def test_a_body_is_sent_whole_again(kind: str) -> None:
    seen: list[httpx.Request] = []
    answers = [error_answer(DOWN), error_answer(UnknownTask("no such task"))]
    with (
        of_kind(kind, served(kind, answers, seen), retries=AT_ONCE) as sparge,
        pytest.raises(UnknownTask),
    ):
        sparge.grasp_file("a.ply", b"ply" * 1000, "pouring")
    assert len(seen) == 2
    assert all(b"ply" * 1000 in request.content for request in seen)


def test_clients_do_not_repeat_a_change(kind: str) -> None:
    seen: list[httpx.Request] = []
    answers = [error_answer(DOWN), httpx.Response(200, json=TASKS)]
    with (
        of_kind(kind, served(kind, answers, seen), retries=AT_ONCE) as sparge,
        pytest.raises(StageUnavailable) as caught,
    ):
        sparge.add_task("watering", requires=["contain"])
    assert len(seen) == 1
    assert caught.value.request_id == "abc"


def test_an_error_that_never_arrived_names_the_request_all_the_same(kind: str) -> None:
    seen: list[httpx.Request] = []
    with (
        of_kind(kind, served(kind, [RESET], seen), retries=RetryPolicy(attempts=1)) as sparge,
        pytest.raises(StageUnavailable) as caught,
    ):
        sparge.grippers()
    assert caught.value.request_id == seen[0].headers["x-request-id"]
