"""Traces: spans of services and of calls between them, and nothing at all when not asked for."""

from __future__ import annotations

import asyncio
import subprocess
import sys
import time
from collections.abc import Iterator

import httpx
import numpy as np
import pytest
from fastapi import FastAPI

from shared.errors import DeadlineExceeded
from shared.schemas.grasp import SELECT, SelectRequest, SelectResponse
from shared.service import StageClient, bind, create_service, tracing
from shared.settings import ServiceSettings
from tests.support.collector import CLIENT, SERVER, Collector, Span, traced
from tests.support.serving import in_process, over_socket, serving

REQUEST = SelectRequest(
    points=np.zeros((2, 3)), point_region=np.array([True, False]), grasps=np.zeros((1, 9))
)
ROBOT_TRACE = "0af7651916cd43dd8448eb211c80319c"
ROBOT_SPAN = "b7ad6b7169203331"


@pytest.fixture
def collector() -> Iterator[Collector]:
    with traced() as running:
        yield running


def stage() -> FastAPI:
    def echo(request: SelectRequest) -> SelectResponse:
        return SelectResponse(
            grasps=request.grasps, indices=np.arange(1, dtype=np.int32), outside_region=0
        )

    return create_service("matching", "test", ServiceSettings(), [bind(SELECT, echo)])


async def ask(url: str, timeout_s: float = 5.0) -> None:
    provider = tracing.tracer_provider("gateway")
    assert provider is not None
    async with httpx.AsyncClient(base_url=url) as http:
        tracer = provider.get_tracer("test")
        await StageClient("matching", http, tracer).call(SELECT, REQUEST, timeout_s)


def named(collector: Collector, service: str) -> Span:
    (found,) = [each for each in collector.spans if each.service == service]
    return found


@pytest.mark.parametrize("serve", [in_process, over_socket], ids=["in_process", "socket"])
def test_a_request_has_a_span_and_health_has_none(collector: Collector, serve: object) -> None:
    assert callable(serve)
    with serve(stage()) as client:
        client.request("GET", "/health/ready")
        client.request("GET", "/metrics")
        client.request(
            "POST",
            "/select",
            json={},
            headers={
                "X-Request-ID": "robot-7",
                "traceparent": f"00-{ROBOT_TRACE}-{ROBOT_SPAN}-01",
            },
        )
    (span,) = collector.spans
    assert (span.service, span.name, span.kind) == ("sparge-matching", "POST /select", SERVER)
    assert (span.trace.hex(), span.parent.hex()) == (ROBOT_TRACE, ROBOT_SPAN)
    assert span.attributes["http.route"] == "/select"
    assert span.attributes["http.response.status_code"] == 422
    assert span.attributes["sparge.request_id"] == "robot-7"


def test_a_call_to_a_stage_is_one_trace(collector: Collector) -> None:
    with serving(stage()) as url:
        asyncio.run(ask(url))
    asked, answered = named(collector, "sparge-gateway"), named(collector, "sparge-matching")
    assert (asked.kind, answered.kind) == (CLIENT, SERVER)
    assert asked.trace == answered.trace
    assert answered.parent == asked.id
    assert asked.attributes["url.full"] == f"{url}/select"
    assert asked.attributes["server.port"] == int(url.rsplit(":", 1)[1])
    assert asked.attributes["http.response.status_code"] == 200


def test_a_call_that_fails_says_how(collector: Collector) -> None:
    with serving(stage()) as url, pytest.raises(DeadlineExceeded):
        asyncio.run(ask(url, timeout_s=1e-4))
    assert named(collector, "sparge-gateway").attributes["error.type"] == "TimeoutError"


def test_a_name_of_ones_own_wins(collector: Collector, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OTEL_SERVICE_NAME", "left arm")
    with in_process(stage()) as client:
        client.request("GET", "/version")
    assert [each.service for each in collector.spans] == ["left arm"]


def test_a_collector_that_is_down_delays_no_stop(
    collector: Collector, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tracing, "_FLUSH_S", 0.1)
    monkeypatch.setattr(collector, "take", lambda _: time.sleep(2))
    with in_process(stage()) as client:
        client.request("GET", "/version")
        started = time.monotonic()
    assert time.monotonic() - started < 1.5


def test_nothing_is_loaded_unless_it_is_asked_for() -> None:
    code = (
        "import sys; from services.matching.app import create_app; create_app();"
        "print([each for each in sys.modules if each.startswith(('opentelemetry.sdk',"
        " 'opentelemetry.exporter', 'google.protobuf', 'requests'))])"
    )
    assert run(code, {}).stdout.strip() == "[]"


@pytest.mark.parametrize("off", [("OTEL_SDK_DISABLED", "true"), ("OTEL_TRACES_EXPORTER", "none")])
def test_it_can_be_switched_off(off: tuple[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OTEL_EXPORTER_OTLP_ENDPOINT", "http://127.0.0.1:9")
    assert tracing.configured()
    monkeypatch.setenv(*off)
    assert not tracing.configured()
    assert tracing.tracer_provider("gateway") is None


def test_a_missing_extra_is_one_warning() -> None:
    code = (
        "import sys; sys.modules['opentelemetry.exporter'] = None\n"
        "from services.matching.app import create_app\n"
        "create_app(); create_app()"
    )
    done = run(code, {"OTEL_EXPORTER_OTLP_TRACES_ENDPOINT": "http://127.0.0.1:9/v1/traces"})
    (line,) = done.stderr.splitlines()
    assert "sparge[tracing]" in line


def test_another_protocol_is_a_warning() -> None:
    code = "from services.matching.app import create_app; create_app()"
    environment = {
        "OTEL_EXPORTER_OTLP_ENDPOINT": "http://127.0.0.1:9",
        "OTEL_EXPORTER_OTLP_PROTOCOL": "grpc",
    }
    assert "http/protobuf only, not as grpc" in run(code, environment).stderr


def run(code: str, environment: dict[str, str]) -> subprocess.CompletedProcess[str]:
    path = ":".join(each for each in sys.path if each)
    return subprocess.run(
        [sys.executable, "-c", code],
        env={"PYTHONPATH": path, **environment},
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
