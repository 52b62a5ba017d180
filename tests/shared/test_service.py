"""What every service promises: envelope, limits, ids, readiness, metrics."""

from __future__ import annotations

import asyncio
import math
import socket
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import httpx
import numpy as np
import orjson
import pytest
from fastapi import FastAPI

from shared.deadline import remaining_s, within
from shared.errors import (
    DeadlineExceeded,
    NotFound,
    StageUnavailable,
    UnknownTask,
)
from shared.schemas.grasp import SELECT, SelectRequest, SelectResponse
from shared.schemas.task import DELETE_TASK, Task, TaskName
from shared.service import StageClient, bind, create_service
from shared.service.local import LocalClient
from shared.settings import ServiceSettings
from tests.support.serving import Client, in_process, over_socket, serving

REQUEST = SelectRequest(
    points=np.zeros((2, 3)), point_region=np.array([True, False]), grasps=np.zeros((1, 9))
)
BODY = {"points": [[0, 0, 0]], "point_region": [True], "grasps": []}


def echo(request: SelectRequest) -> SelectResponse:
    grasps = np.asarray(request.grasps).reshape(-1, 9)
    return SelectResponse(
        grasps=grasps, indices=np.arange(len(grasps), dtype=np.int32), outside_region=0
    )


def service(
    handler: Callable[[SelectRequest], SelectResponse] = echo,
    warm_up: Callable[[], object] = lambda: None,
    afterwards: Callable[[], object] | None = None,
    close: Callable[[], object] = lambda: None,
    **limits: Any,
) -> FastAPI:
    return create_service(
        "matching",
        "test",
        ServiceSettings(**{"max_body_bytes": 10_000, **limits}),
        [bind(SELECT, handler)],
        warm_up=warm_up,
        afterwards=afterwards,
        close=close,
    )


@pytest.fixture(params=[in_process, over_socket], ids=["in_process", "socket"])
def client(request: pytest.FixtureRequest) -> Iterator[Client]:
    with request.param(service()) as served:
        yield served


def error(response: httpx.Response) -> dict[str, Any]:
    assert response.headers["content-type"] == "application/json"
    body = response.json()
    assert set(body) == {"error"}
    assert set(body["error"]) == {"code", "message", "details", "request_id"}
    assert body["error"]["request_id"] == response.headers["x-request-id"]
    found: dict[str, Any] = body["error"]
    return found


def test_unknown_paths_and_methods_have_the_envelope(client: Client) -> None:
    assert error(client.request("GET", "/nowhere"))["code"] == "no_such_path"
    wrong = client.request("PUT", "/select")
    assert wrong.status_code == 405
    assert error(wrong)["code"] == "method_not_allowed"


def test_a_large_body_is_refused(client: Client) -> None:
    response = client.request("POST", "/select", content=b"x" * 20_000)
    assert response.status_code == 413
    assert error(response)["details"] == {"found": 20_000, "allowed": 10_000}


def test_a_large_body_of_undeclared_length_is_refused() -> None:
    with over_socket(service()) as client:
        response = client.request("POST", "/select", content=(b"x" * 4_000 for _ in range(5)))
    assert response.status_code == 413
    assert error(response)["code"] == "too_large"


def test_request_ids_pass_through_or_are_made(client: Client) -> None:
    given = client.request("GET", "/nowhere", headers={"X-Request-ID": "robot-7.42"})
    assert error(given)["request_id"] == "robot-7.42"
    forged = client.request("GET", "/nowhere", headers={"X-Request-ID": "a b<script>"})
    assert error(forged)["request_id"] != "a b<script>"


def test_health_version_and_metrics(client: Client) -> None:
    assert client.request("GET", "/health/live").json()["status"] == "alive"
    assert client.request("GET", "/health/ready").json()["status"] == "ready"
    assert client.request("GET", "/version").json()["service"] == "matching"
    client.request("POST", "/select", json=BODY)
    text = client.request("GET", "/metrics").text
    counted = 'sparge_requests_total{route="/select",service="matching",status="200"} 1.0'
    assert counted in text


def test_a_fault_of_ours_shows_no_traceback() -> None:
    def broken(request: SelectRequest) -> SelectResponse:
        raise ZeroDivisionError("secret of the house")

    with in_process(service(broken)) as client:
        response = client.request("POST", "/select", json=BODY)
        assert response.status_code == 500
        assert "secret" not in response.text
        assert error(response)["code"] == "internal"


def test_a_stage_answers_only_when_warm() -> None:
    gate = threading.Event()
    with serving(service(warm_up=gate.wait)) as url, httpx.Client(base_url=url) as client:
        cold = client.get("/health/ready")
        assert (cold.status_code, cold.json()["status"]) == (503, "starting")
        refused = client.post("/select", json=BODY)
        assert refused.status_code == 503
        assert refused.headers["retry-after"]
        assert error(refused)["code"] == "stage_unavailable"
        gate.set()
        while client.get("/health/ready").status_code != 200:
            pass
        assert client.post("/select", json=BODY).status_code == 200


def test_what_few_requests_need_is_warmed_up_afterwards(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shared.service.stage.AFTERWARDS_S", 0.0)
    gate, done = threading.Event(), threading.Event()

    def later() -> None:
        gate.wait()
        done.set()

    with in_process(service(afterwards=later)) as client:
        assert client.request("POST", "/select", json=BODY).status_code == 200
        assert not done.is_set()
        gate.set()
        assert done.wait(10.0)
        assert client.request("GET", "/health/ready").status_code == 200


def test_nobody_who_ends_waits_for_what_has_begun(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shared.service.stage.AFTERWARDS_S", 0.0)
    begun, never = threading.Event(), threading.Event()

    def later() -> None:
        begun.set()
        never.wait(20.0)

    with in_process(service(afterwards=later)):
        assert begun.wait(10.0)
        started = time.monotonic()
    assert time.monotonic() - started < 5.0
    never.set()


def test_who_ends_at_once_does_not_wait_for_it() -> None:
    calls: list[int] = []
    with in_process(service(afterwards=lambda: calls.append(1))) as client:
        assert client.request("POST", "/select", json=BODY).status_code == 200
    assert calls == []


def test_a_request_that_came_too_late_is_not_worked_on(client: Client) -> None:
    late = client.request("POST", "/select", json=BODY, headers={"X-Request-Timeout": "0"})
    assert (late.status_code, error(late)["code"]) == (504, "deadline_exceeded")
    odd = client.request("POST", "/select", json=BODY, headers={"X-Request-Timeout": "soon"})
    assert (odd.status_code, error(odd)["code"]) == (400, "malformed")


def test_the_deadline_reaches_the_work_of_a_stage() -> None:
    left: list[float] = []

    def look(request: SelectRequest) -> SelectResponse:
        left.append(remaining_s())
        return echo(request)

    with in_process(service(look)) as client:
        client.request("POST", "/select", json=BODY, headers={"X-Request-Timeout": "3.5"})
        client.request("POST", "/select", json=BODY)
    assert 3.0 < left[0] <= 3.5
    assert left[1] == math.inf


def test_a_request_does_not_inherit_the_deadline_of_the_one_before() -> None:
    """The body is so large that reading is paused, and resumed while it is answered."""
    large = b" " * 2_000_000 + orjson.dumps(BODY)
    with (
        serving(service(max_body_bytes=10_000_000)) as url,
        httpx.Client(base_url=url, timeout=60) as client,
    ):
        Client(client.request).wait_until_ready(60)
        client.post("/select", content=large, headers={"X-Request-Timeout": "1"})
        time.sleep(1.2)
        for _ in range(3):
            assert client.post("/select", content=large).status_code == 200


def test_a_client_says_how_much_time_is_left() -> None:
    sent: list[float] = []

    def answer(request: httpx.Request) -> httpx.Response:
        sent.append(float(request.headers["X-Request-Timeout"]))
        return httpx.Response(422, json=UnknownTask("no").envelope("id"))

    for seconds in (5.0, 60.0):
        with within(10.0), pytest.raises(UnknownTask):
            call(httpx.MockTransport(answer), timeout_s=seconds)
    assert sent == pytest.approx([5.0, 10.0], abs=0.5)


def test_a_stage_with_no_room_says_when_to_come_again() -> None:
    gate, begun = threading.Event(), threading.Semaphore(0)

    def wait(request: SelectRequest) -> SelectResponse:
        begun.release()
        gate.wait()
        return echo(request)

    with (
        in_process(service(wait, max_running=1, max_waiting=0)) as client,
        ThreadPoolExecutor(1) as others,
    ):
        first = others.submit(client.request, "POST", "/select", json=BODY)
        begun.acquire()
        refused = client.request("POST", "/select", json=BODY)
        metrics = client.request("GET", "/metrics").text
        gate.set()
        assert first.result().status_code == 200
    assert (refused.status_code, error(refused)["code"]) == (429, "too_busy")
    assert int(refused.headers["retry-after"]) >= 1
    assert 'sparge_queue_running{service="matching"} 1.0' in metrics
    assert 'sparge_queue_rejected_total{service="matching"} 1.0' in metrics


def test_a_body_that_does_not_arrive_is_given_up() -> None:
    with serving(service(body_time_s=0.2)) as url:
        with httpx.Client(base_url=url) as http:
            LocalClient(http.request).wait_until_ready(60)
        host, port = url.removeprefix("http://").split(":")
        with socket.create_connection((host, int(port)), timeout=10) as slow:
            slow.sendall(
                b"POST /select HTTP/1.1\r\nHost: x\r\nContent-Length: 50\r\n"
                b"Content-Type: application/json\r\n\r\n{"
            )
            answer = b"".join(iter(lambda: slow.recv(65536), b"")).decode()
    assert answer.startswith("HTTP/1.1 408")
    assert "body_too_slow" in answer


def test_a_failed_warm_up_is_told() -> None:
    def fail() -> None:
        raise RuntimeError("SWI-Prolog is not installed")

    with pytest.raises(StageUnavailable, match="SWI-Prolog"), in_process(service(warm_up=fail)):
        pass


def test_close_is_called_once() -> None:
    calls: list[int] = []
    with in_process(service(close=lambda: calls.append(1))):
        assert calls == []
    assert calls == [1]


def call(transport: httpx.AsyncBaseTransport, timeout_s: float = 5.0) -> SelectResponse:
    async def ask() -> SelectResponse:
        async with httpx.AsyncClient(transport=transport, base_url="http://stage") as http:
            return await StageClient("matching", http).call(SELECT, REQUEST, timeout_s)

    return asyncio.run(ask())


def answering(response: httpx.Response) -> httpx.MockTransport:
    return httpx.MockTransport(lambda request: response)


def test_the_client_gets_the_message_back() -> None:
    async def ask() -> SelectResponse:
        app = service()
        transport = httpx.ASGITransport(app=app, raise_app_exceptions=False)
        async with (
            app.router.lifespan_context(app),
            httpx.AsyncClient(transport=transport, base_url="http://stage") as http,
        ):
            stage = StageClient("matching", http)
            while (await stage.health(5)).status != "ready":
                await asyncio.sleep(0.01)
            return await stage.call(SELECT, REQUEST, 5)

    assert asyncio.run(ask()) == echo(REQUEST)


def test_the_client_rebuilds_the_error_that_the_stage_raised() -> None:
    sent = UnknownTask("unknown task 'dancing'", known=["pouring"])
    with pytest.raises(UnknownTask) as caught:
        call(answering(httpx.Response(422, json=sent.envelope("id"))))
    assert caught.value.details == {"known": ["pouring"], "stage": "matching"}


@pytest.mark.parametrize(
    "response",
    [
        httpx.Response(200, content=b"{}", headers={"content-type": "application/json"}),
        httpx.Response(200, content=b"PK nonsense", headers={"content-type": "application/x-npz"}),
        httpx.Response(200, content=b"<html>", headers={"content-type": "text/html"}),
        httpx.Response(302),
        httpx.Response(404, json=NotFound("no").envelope("id") | {"error": "odd"}),
        httpx.Response(500, content=b"Internal Server Error"),
        httpx.Response(502, json={"error": {"code": "internal", "message": "x", "details": {}}}),
    ],
)
def test_nonsense_makes_the_stage_unavailable(response: httpx.Response) -> None:
    with pytest.raises(StageUnavailable, match="matching"):
        call(answering(response))


def test_a_missing_stage_is_named() -> None:
    with pytest.raises(StageUnavailable, match="matching cannot be reached"):
        call(httpx.AsyncHTTPTransport(), timeout_s=5)


def test_the_deadline_holds_in_process_too() -> None:
    async def hang(request: httpx.Request) -> httpx.Response:
        await asyncio.sleep(60)
        raise AssertionError

    with pytest.raises(DeadlineExceeded, match="matching"):
        call(httpx.MockTransport(hang), timeout_s=0.05)


def test_path_parameters_are_filled_in() -> None:
    seen: list[str] = []

    def answer(request: httpx.Request) -> httpx.Response:
        seen.append(f"{request.method} {request.url.path}")
        return httpx.Response(404, json=NotFound("no task 'stirring'").envelope("id"))

    async def ask() -> Task:
        transport = httpx.MockTransport(answer)
        async with httpx.AsyncClient(transport=transport, base_url="http://stage") as http:
            return await StageClient("reasoning", http).call(
                DELETE_TASK, TaskName(name="stirring"), 1
            )

    with pytest.raises(NotFound, match="stirring"):
        asyncio.run(ask())
    assert seen == ["DELETE /tasks/stirring"]


def test_errors_say_what_was_found() -> None:
    with in_process(service()) as client:
        response = client.request("POST", "/select", json={**BODY, "point_region": [1]})
    assert response.status_code == 422
    assert "point_region: has dtype int64, allowed is bool" in str(error(response)["message"])
