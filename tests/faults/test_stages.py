"""Every stage, failing in every way: the answer, the stage that it names, its time, and after."""

from __future__ import annotations

import itertools
import os
import time
import zlib
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import httpx
import numpy as np
import pytest

import shared.service.client
from services.gateway.app import create_app
from services.gateway.settings import STAGES, GatewaySettings
from shared.errors import InternalError, InvalidInput, TooBusy
from shared.wire import JSON, NPZ
from shared.wire.npz import write_npz
from tests.faults.conftest import DEADLINE_S, SLACK_S, Backend
from tests.faults.faulty import Exchange, Fault
from tests.support.asking import REQUESTS, failed
from tests.support.samples import sample_path
from tests.support.serving import serving

every_stage = pytest.mark.parametrize("stage", STAGES)
AT_ONCE_S = DEADLINE_S - 0.1
AS_NPZ, AS_JSON = {"content-type": NPZ}, {"content-type": JSON}


def hung(exchange: Exchange) -> None:
    """Takes the request and says nothing."""
    exchange.wait()


def trickling(exchange: Exchange) -> None:
    """Sends the true answer, a byte at a time."""
    answer = exchange.true_answer()
    exchange.send(f"HTTP/1.1 200 x\r\ncontent-length: {len(answer.content)}\r\n".encode())
    exchange.send(f"content-type: {answer.headers['content-type']}\r\n\r\n".encode())
    for byte in answer.content:
        exchange.send(bytes([byte]))
        if not exchange.wait(0.05):
            return


def late(exchange: Exchange) -> None:
    """Takes a while, but not too long."""
    if exchange.wait(0.2):
        exchange.pass_on()


def gone(exchange: Exchange) -> None:
    """Closes the connection without a word."""


def crashed(exchange: Exchange) -> None:
    exchange.reset()


def half_an_answer(exchange: Exchange) -> None:
    answer = exchange.true_answer()
    half = answer.content[: len(answer.content) // 2]
    exchange.answer(half, AS_NPZ, length=len(answer.content))


def half_a_head(exchange: Exchange) -> None:
    exchange.send(b"HTTP/1.1 200 OK\r\ncontent-ty")


def half_an_archive(exchange: Exchange) -> None:
    """Half, and it says so: nothing is wrong but the content."""
    content = exchange.true_answer().content
    exchange.answer(content[: len(content) // 2], AS_NPZ)


def noise(exchange: Exchange) -> None:
    exchange.send(os.urandom(1000))


def noise_as_archive(exchange: Exchange) -> None:
    exchange.answer(os.urandom(1000), AS_NPZ)


def another_message(exchange: Exchange) -> None:
    exchange.answer(write_npz({"points": np.zeros((3, 3))}), AS_NPZ)


def a_lying_archive(exchange: Exchange) -> None:
    content = exchange.true_answer().content
    exchange.answer(content.replace(b"'shape': (", b"'shape': (9"), AS_NPZ)


def a_web_page(exchange: Exchange) -> None:
    exchange.answer(b"<html>It works!</html>", {"content-type": "text/html"})


def the_wrong_type(exchange: Exchange) -> None:
    exchange.answer(exchange.true_answer().content, AS_JSON)


def no_type(exchange: Exchange) -> None:
    exchange.answer(exchange.true_answer().content)


def nothing(exchange: Exchange) -> None:
    exchange.answer(b"", AS_NPZ)


def a_traceback(exchange: Exchange) -> None:
    exchange.answer(b"Traceback: secret", {"content-type": "text/plain"}, status=500)


def a_fault_of_its_own(exchange: Exchange) -> None:
    error = InternalError("an internal error").envelope("-")
    exchange.answer(httpx.Response(500, json=error).content, AS_JSON, status=500)


def another_place(exchange: Exchange) -> None:
    exchange.answer(b"", {"location": "http://127.0.0.1:9/"}, status=307)


def no_such_path(exchange: Exchange) -> None:
    exchange.answer(b'{"detail": "Not Found"}', AS_JSON, status=404)


def packed_nonsense(exchange: Exchange) -> None:
    exchange.answer(b"not gzip", AS_NPZ | {"content-encoding": "gzip"})


def packed_zeros(exchange: Exchange) -> None:
    """A megabyte that would become a gigabyte."""
    packer = zlib.compressobj(9, zlib.DEFLATED, 31)
    block = packer.compress(bytes(2**24)) + packer.flush(zlib.Z_FULL_FLUSH)
    exchange.answer(block * 60, AS_NPZ | {"content-encoding": "gzip"})


def headers_without_end(exchange: Exchange) -> None:
    exchange.send(b"HTTP/1.1 200 OK\r\n")
    for number in itertools.count():
        exchange.send(b"x-%d: y\r\n" % number * 1000)
        if not exchange.wait(0.005):
            return


FAULTS: dict[Fault, str] = {
    gone: "cannot be reached",
    crashed: "cannot be reached",
    half_an_answer: "cannot be reached",
    half_a_head: "cannot be reached",
    noise: "cannot be reached",
    headers_without_end: "cannot be reached",
    half_an_archive: "answered nonsense",
    noise_as_archive: "answered nonsense",
    another_message: "answered nonsense",
    a_lying_archive: "answered nonsense",
    a_web_page: "answered nonsense",
    the_wrong_type: "answered nonsense",
    no_type: "answered nonsense",
    nothing: "answered nonsense",
    packed_nonsense: "answered nonsense",
    packed_zeros: "answered nonsense",
    a_traceback: "answered 500",
    another_place: "answered 307",
    no_such_path: "answered 404",
    a_fault_of_its_own: "failed",
}


@every_stage
@pytest.mark.parametrize(
    "fault", [crashed, half_an_answer, noise, noise_as_archive, the_wrong_type]
)
def test_one_that_fails_at_once_is_named_at_once(
    backend: Backend, stage: str, fault: Fault
) -> None:
    with backend.stages[stage].failing(fault):
        response, taken = backend.ask(stage)
    assert FAULTS[fault] in failed(response, 503, "stage_unavailable", stage)
    assert taken < AT_ONCE_S
    backend.works(stage)


@pytest.mark.parametrize("fault", FAULTS)
def test_every_way_to_fail_at_once(backend: Backend, fault: Fault) -> None:
    with backend.stages["reasoning"].failing(fault):
        started = time.monotonic()
        response = backend.http.get("/tasks")
        taken = time.monotonic() - started
    assert FAULTS[fault] in failed(response, 503, "stage_unavailable", "reasoning")
    assert "secret" not in response.text
    assert taken < AT_ONCE_S
    assert backend.http.get("/tasks").status_code == 200


@pytest.mark.parametrize(
    ("stage", "fault"), [*((each, hung) for each in STAGES), ("reasoning", trickling)]
)
def test_one_that_does_not_come_to_an_end_is_named_at_the_deadline(
    backend: Backend, stage: str, fault: Fault
) -> None:
    with backend.stages[stage].failing(fault):
        response, taken = backend.ask(stage)
    failed(response, 504, "deadline_exceeded", stage)
    assert DEADLINE_S - 0.1 < taken < DEADLINE_S + SLACK_S
    backend.works(stage)


@every_stage
def test_one_that_is_slow_is_waited_for(backend: Backend, stage: str) -> None:
    with backend.stages[stage].failing(late):
        response, taken = backend.ask(stage)
    assert response.status_code == 200, response.text
    assert taken > 0.2


@every_stage
def test_its_own_refusals_come_through(backend: Backend, stage: str) -> None:
    for error in (TooBusy("all are taken"), InvalidInput("not like this")):
        sent = httpx.Response(error.status, json=error.envelope("-")).content

        def refuse(exchange: Exchange, sent: bytes = sent, status: int = error.status) -> None:
            exchange.answer(sent, AS_JSON, status=status)

        with backend.stages[stage].failing(refuse):
            response, _ = backend.ask(stage)
        told = response.json()["error"]
        assert (response.status_code, told["code"]) == (error.status, error.code)
        assert told["details"]["stage"] == stage
        backend.works(stage)


def test_an_answer_without_end_is_cut_off(
    backend: Backend, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shared.service.client, "MAX_ANSWER_BYTES", 2**20)

    def endless(exchange: Exchange) -> None:
        exchange.send(b"HTTP/1.1 200 OK\r\ncontent-type: application/x-npz\r\n\r\n")
        while exchange.wait(0.001):
            exchange.send(bytes(2**18))

    with backend.stages["matching"].failing(endless):
        response, taken = backend.ask("matching")
    assert "more than 1048576 bytes" in failed(response, 503, "stage_unavailable", "matching")
    assert taken < AT_ONCE_S
    backend.works("matching")


def test_a_hundred_at_a_hung_stage_are_all_told_and_leave_nothing_behind(
    backend: Backend,
) -> None:
    """More than the gateway keeps connections for."""
    with backend.stages["reasoning"].failing(hung), ThreadPoolExecutor(100) as pool:
        started = time.monotonic()
        answers = list(pool.map(lambda _: backend.http.get("/tasks"), range(100)))
        taken = time.monotonic() - started
    for answer in answers:
        failed(answer, 504, "deadline_exceeded", "reasoning")
    assert taken < DEADLINE_S + 3 * SLACK_S
    assert backend.http.get("/tasks").status_code == 200
    backend.works("reasoning")


def test_health_tells_which_stage_hangs_before_a_probe_gives_up(backend: Backend) -> None:
    stage = backend.stages["matching"]
    with stage.failing(hung, health=True):
        assert backend.http.get("/health/live").status_code == 200
        started = time.monotonic()
        response = backend.http.get("/health/ready")
        taken = time.monotonic() - started
    assert (response.status_code, list(response.json()["details"])) == (503, ["matching"])
    assert taken < 4, "what docker/health.py waits"
    assert backend.http.get("/health/ready").status_code == 200


def test_what_does_not_need_the_stage_goes_on(backend: Backend) -> None:
    with backend.stages["perception"].failing(hung):
        assert backend.http.get("/tasks").status_code == 200
        assert backend.http.get("/grippers").status_code == 200
        backend.works("execution")


def heavy(backend: Backend, rehearsal: str) -> tuple[httpx.Response, float]:
    """Ask about a saucepan, whose weight turns it between the pads."""
    started = time.monotonic()
    response = backend.http.post(
        "/grasp",
        params={"task": "cooking", "rehearsal": rehearsal},
        content=sample_path("saucepan").read_bytes(),
        headers={"content-type": NPZ},
    )
    return response, time.monotonic() - started


@pytest.mark.parametrize(
    ("fault", "code"),
    [
        (gone, "stage_unavailable"),
        (half_an_archive, "stage_unavailable"),
        (a_fault_of_its_own, "stage_unavailable"),
        (hung, "deadline_exceeded"),
    ],
)
def test_grasps_are_answered_unrehearsed_where_the_simulation_fails(
    backend: Backend, fault: Fault, code: str
) -> None:
    with backend.stages["execution"].failing(fault):
        response, taken = heavy(backend, "auto")
        refused, _ = heavy(backend, "always")
    assert response.status_code == 200, response.text
    assert response.json()["rehearsal"] == {"tried": 0, "stopped": code}
    assert response.json()["grasps"]
    assert taken < DEADLINE_S, "half of what is left of its time goes into the rehearsal"
    status = {"stage_unavailable": 503, "deadline_exceeded": 504}[code]
    failed(refused, status, code, "execution")
    backend.works("execution")


def test_a_gateway_rehearses_in_its_own_way_what_does_not_say(backend: Backend) -> None:
    urls: dict[str, Any] = {f"{name}_url": stage.url for name, stage in backend.stages.items()}
    settings = GatewaySettings(**urls, samples=20, rehearsal="always")
    with serving(create_app(settings)) as url, httpx.Client(base_url=url, timeout=60) as http:
        told = [
            http.post("/grasp", json={**REQUESTS["perception"][1], **more}).json()
            for more in ({}, {"rehearsal": "never"})
        ]
    assert told[0]["rehearsal"]["tried"] > 0
    assert "rehearsal" not in told[1]
