"""Logs: one line per request, JSON or text, also of uvicorn itself; no secret in them."""

from __future__ import annotations

import json
import logging
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from pydantic import ValidationError

from shared.schemas.grasp import SELECT, SelectRequest, SelectResponse
from shared.service import bind, create_service
from shared.service.exchange import IN_PROCESS, Exchange
from shared.service.logs import JsonFormatter, LogSettings, log_exchange
from shared.settings import ServiceSettings
from tests.support.serving import free_ports, in_process

SECRET = "Bearer do-not-tell"


@contextmanager
def uvicorn(tmp_path: Path, *options: str, **environment: str) -> Iterator[tuple[str, Path]]:
    """Run a stage as the images do; its URL, and the file that its output goes to."""
    (port,) = free_ports(1)
    output = tmp_path / "output"
    with output.open("wb") as stream:
        process = subprocess.Popen(
            [
                *(sys.executable, "-m", "uvicorn", "--factory", "services.matching.app:create_app"),
                *("--port", str(port), *options),
            ],
            env={**os.environ, **environment},
            stdout=stream,
            stderr=stream,
            cwd=Path(__file__).parents[2],
        )
    url = f"http://127.0.0.1:{port}"
    try:
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            try:
                if httpx.get(f"{url}/health/ready").status_code == 200:
                    break
            except httpx.TransportError:
                assert process.poll() is None, output.read_text()
                time.sleep(0.05)
        yield url, output
    finally:
        process.terminate()
        process.wait(timeout=10)


def test_every_line_is_json(tmp_path: Path) -> None:
    with uvicorn(tmp_path, SPARGE_LOG_FORMAT="json") as (url, output):
        httpx.get(f"{url}/metrics")
        httpx.post(
            f"{url}/select?key=do-not-tell",
            content=b'{"points": "do-not-tell"}',
            headers={"X-Request-ID": "robot-7", "Authorization": SECRET},
        )
    text = output.read_text()
    records = [json.loads(line) for line in text.splitlines()]
    assert all({"time", "level", "logger", "message", "request_id"} <= set(r) for r in records)
    assert {"uvicorn.error", "sparge.access"} == {each["logger"] for each in records}
    (line,) = [each for each in records if each["logger"] == "sparge.access"]
    assert line["request_id"] == "robot-7"
    asked = {"service": "matching", "method": "POST", "route": "/select", "status": 422}
    assert asked.items() <= line.items()
    assert line["code"] == "invalid_input"
    assert line["bytes_in"] == 25
    assert line["bytes_out"] > 100
    assert line["ms"] > 0
    assert "do-not-tell" not in text


def test_text_is_the_default_and_the_level_can_be_set(tmp_path: Path) -> None:
    with uvicorn(tmp_path) as (url, output):
        httpx.get(f"{url}/version", headers={"X-Request-ID": "robot-7"})
    assert "matching GET /version 200 in" in output.read_text()
    assert "[robot-7]" in output.read_text()
    assert "/health/ready" not in output.read_text()
    with uvicorn(tmp_path, "--log-level=debug", SPARGE_LOG_LEVEL="warning") as (url, output):
        httpx.get(f"{url}/version")
    assert output.read_text() == ""


def test_the_id_reaches_worker_threads_and_a_fault_is_one_record(
    caplog: pytest.LogCaptureFixture,
) -> None:
    lines: list[str] = []

    class Kept(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            lines.append(self.format(record))

    def broken(request: SelectRequest) -> SelectResponse:
        logging.getLogger("sparge").warning("in a thread", extra={"points": len(request.points)})
        raise ZeroDivisionError("a fault of ours")

    handler = Kept()
    handler.setFormatter(JsonFormatter())
    service = create_service("matching", "test", ServiceSettings(), [bind(SELECT, broken)])
    body = {"points": np.zeros((2, 3)).tolist(), "point_region": [True, False], "grasps": []}
    log = logging.getLogger("sparge")
    log.addHandler(handler)
    try:
        with caplog.at_level(logging.INFO, "sparge"), in_process(service) as client:
            client.request("POST", "/select", json=body, headers={"X-Request-ID": "robot-7"})
    finally:
        log.removeHandler(handler)
    records: list[dict[str, Any]] = [json.loads(line) for line in lines]
    threaded, fault, line = records
    assert {each["request_id"] for each in records} == {"robot-7"}
    assert (threaded["message"], threaded["points"]) == ("in a thread", 2)
    assert "ZeroDivisionError: a fault of ours" in fault["exception"]
    assert fault["level"] == "error"
    assert (line["status"], line["code"]) == (500, "internal")


def test_whatever_json_does_not_know_is_text() -> None:
    record = logging.makeLogRecord({"msg": "at %s", "args": (Path("/a"),), "where": Path("/b")})
    found = json.loads(JsonFormatter().format(record))
    assert (found["message"], found["where"]) == ("at /a", "/b")


def test_a_wrong_setting_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SPARGE_LOG_FORMAT", "xml")
    with pytest.raises(ValidationError, match=r"format\n.*'text' or 'json'"):
        LogSettings()


def test_what_machines_poll_and_mere_steps_are_quiet(caplog: pytest.LogCaptureFixture) -> None:
    def line(route: str = "/tasks", client: str = "127.0.0.1") -> Exchange:
        return Exchange("GET", route, 200, 0.1, 0, 10, client, None)

    with caplog.at_level(logging.DEBUG, "sparge"):
        for each in (line(), line(route="/health/ready"), line(client=IN_PROCESS[0])):
            log_exchange("gateway", each)
    assert [each.levelno for each in caplog.records] == [logging.INFO, logging.DEBUG, logging.DEBUG]
