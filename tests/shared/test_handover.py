"""A stage of the same process is handed messages; nobody can tell it from one behind HTTP."""

from __future__ import annotations

import asyncio
import contextlib
import re
import threading
import time
from collections.abc import AsyncIterator, Callable, Iterator
from typing import Any

import httpx
import numpy as np
import pytest
from fastapi import FastAPI

from shared.deadline import check_deadline, remaining_s
from shared.errors import DeadlineExceeded, SpargeError, StageUnavailable, TooBusy, UnknownTask
from shared.schemas.grasp import SELECT, SelectRequest, SelectResponse
from shared.service import LocalStage, Stage, StageClient, bind, create_service, tracing
from shared.service.request_id import request_id
from shared.settings import ServiceSettings
from tests.support.collector import CLIENT, SERVER, traced

REQUEST = SelectRequest(
    points=np.zeros((2, 3)), point_region=np.array([True, False]), grasps=np.zeros((1, 9))
)
Handler = Callable[[SelectRequest], SelectResponse]
Reach = Callable[[FastAPI], contextlib.AbstractAsyncContextManager[Stage]]


@pytest.fixture
def robot_7() -> Iterator[None]:
    """Have a request id while the test runs."""
    token = request_id.set("robot-7")
    yield
    request_id.reset(token)


def echo(request: SelectRequest) -> SelectResponse:
    return SelectResponse(
        grasps=request.grasps, indices=np.arange(1, dtype=np.int32), outside_region=0
    )


def app_of(handler: Handler = echo, warm_up: Any = None, **limits: Any) -> FastAPI:
    settings = ServiceSettings(**limits)
    return create_service("matching", "test", settings, [bind(SELECT, handler)], warm_up=warm_up)


@contextlib.asynccontextmanager
async def over_http(app: FastAPI) -> AsyncIterator[Stage]:
    transport = httpx.ASGITransport(app, raise_app_exceptions=False)
    async with httpx.AsyncClient(transport=transport, base_url="http://stage") as http:
        yield StageClient("matching", http)


@contextlib.asynccontextmanager
async def handed_over(app: FastAPI) -> AsyncIterator[Stage]:
    yield LocalStage("matching", app)


def call(app: FastAPI, reach: Reach = handed_over, timeout_s: float = 5.0, times: int = 1) -> Any:
    """Return the answer or the error of the last of so many calls at once, and the metrics."""

    async def ask() -> Any:
        async with app.router.lifespan_context(app), reach(app) as stage:
            while (await stage.health(5)).status == "starting":
                await asyncio.sleep(0.01)
            calls = (stage.call(SELECT, REQUEST, timeout_s) for _ in range(times))
            return (await asyncio.gather(*calls, return_exceptions=True))[-1]

    return asyncio.run(ask())


def broken(_: SelectRequest) -> SelectResponse:
    raise ZeroDivisionError


def refusing(_: SelectRequest) -> SelectResponse:
    raise UnknownTask("unknown task 'dancing'", known=["pouring"])


def slow(_: SelectRequest) -> SelectResponse:
    time.sleep(0.1)
    return echo(REQUEST)


def unable() -> None:
    raise RuntimeError("SWI-Prolog is not installed")


def told(outcome: Any) -> Any:
    """Return what a caller sees of an error; the rest of a busy queue's wait is measured."""
    if not isinstance(outcome, SpargeError):
        return outcome
    return type(outcome), re.sub(r"[\d.]+ s", "some s", outcome.message), outcome.details


@pytest.mark.parametrize(
    ("make", "options", "kind"),
    [
        (app_of, {}, SelectResponse),
        (lambda: app_of(refusing), {}, UnknownTask),
        (lambda: app_of(broken), {}, StageUnavailable),
        (lambda: app_of(warm_up=unable), {}, StageUnavailable),
        (lambda: app_of(slow), {"timeout_s": 0.02}, DeadlineExceeded),
        (app_of, {"timeout_s": 0.0}, DeadlineExceeded),
        (lambda: app_of(slow, max_running=1, max_waiting=0), {"times": 2}, TooBusy),
    ],
    ids=["answer", "refusal", "failure", "not ready", "too slow", "no time", "busy"],
)
def test_it_is_as_over_http(
    make: Callable[[], FastAPI], options: dict[str, Any], kind: type[Any]
) -> None:
    handed, sent = make(), make()
    outcome = call(handed, handed_over, **options)
    assert isinstance(outcome, kind)
    assert told(outcome) == told(call(sent, over_http, **options))
    assert counted(handed) == counted(sent)


def counted(app: FastAPI) -> dict[str, str]:
    """Return the counts of requests and errors by route, status and code."""
    text = app.state.metrics.expose().body.decode()
    found = dict(re.findall(r"^(sparge_(?:requests|errors)_total\{.*\}) (\S+)$", text, re.M))
    return {name: count for name, count in found.items() if "/health" not in name}


def test_what_is_handed_over_cannot_be_changed() -> None:
    def careless(request: SelectRequest) -> SelectResponse:
        np.asarray(request.grasps)[0, 0] = 1.0
        return echo(request)

    assert isinstance(call(app_of(careless)), StageUnavailable)
    assert REQUEST.grasps[0, 0] == 0.0
    answer = call(app_of())
    assert not answer.grasps.flags.writeable


@pytest.mark.usefixtures("robot_7")
def test_the_handler_knows_the_request_and_its_deadline() -> None:
    seen: list[Any] = []

    def look(request: SelectRequest) -> SelectResponse:
        seen.append((threading.current_thread().name, remaining_s(), request_id.get()))
        return echo(request)

    call(app_of(look), timeout_s=3.0)
    ((thread, left_s, identifier),) = seen
    assert thread != threading.main_thread().name
    assert 0 < left_s <= 3.0
    assert identifier == "robot-7"


def test_work_ends_soon_after_its_deadline() -> None:
    ended = threading.Event()

    def patient(request: SelectRequest) -> SelectResponse:
        try:
            for _ in range(1000):
                time.sleep(0.01)
                check_deadline()
        finally:
            ended.set()
        return echo(request)

    assert isinstance(call(app_of(patient), timeout_s=0.05), DeadlineExceeded)
    assert ended.wait(2.0)


@pytest.mark.usefixtures("robot_7")
def test_a_handover_is_two_spans_of_one_trace() -> None:
    with traced() as collector:
        app = app_of(refusing)
        provider = tracing.tracer_provider("gateway")
        assert provider is not None

        async def ask() -> None:
            stage = LocalStage("matching", app, provider.get_tracer("test"))
            async with app.router.lifespan_context(app):
                while (await stage.health(5)).status == "starting":
                    await asyncio.sleep(0.01)
                with pytest.raises(UnknownTask):
                    await stage.call(SELECT, REQUEST, 5.0)

        asyncio.run(ask())
    by_kind = {each.kind: each for each in collector.spans}
    asked, answered = by_kind[CLIENT], by_kind[SERVER]
    assert len(collector.spans) == 2
    assert (answered.trace, answered.parent) == (asked.trace, asked.id)
    assert answered.service == "sparge-matching"
    assert answered.attributes["http.route"] == "/select"
    assert answered.attributes["http.response.status_code"] == 422
    assert answered.attributes["sparge.request_id"] == "robot-7"
