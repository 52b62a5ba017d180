"""Each service alone under uvicorn, the gateway pointed at them: the embedded answer."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from services.gateway.settings import STAGES
from services.wiring import create_app
from tests.support.samples import sample_path
from tests.support.serving import free_ports, in_process

READY_TIMEOUT_S = 120.0
QUESTIONS = [
    {"task": "cooking", "reasoning": "v1"},
    {"task": "cooking", "reasoning": "v2", "seed": "7"},
    {"task": "handover", "reasoning": "v2"},
    {"task": "hammering", "reasoning": "v2"},
]


@pytest.fixture(scope="module")
def urls(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, str]]:
    """Seven processes, each `uvicorn --factory services.NAME.app:create_app`."""
    names = (*STAGES, "gateway")
    found = {
        name: f"http://127.0.0.1:{port}"
        for name, port in zip(names, free_ports(len(names)), strict=True)
    }
    environment = {
        **os.environ,
        "SPARGE_REASONING_KNOWLEDGE_DIR": str(tmp_path_factory.mktemp("knowledge")),
        **{f"SPARGE_GATEWAY_{name.upper()}_URL": found[name] for name in STAGES},
    }
    processes = [
        subprocess.Popen(
            [
                *(sys.executable, "-m", "uvicorn", "--log-level=warning"),
                f"--port={url.rsplit(':', 1)[1]}",
                *("--factory", f"services.{name}.app:create_app"),
            ],
            env=environment,
            cwd=Path(__file__).parents[2],
        )
        for name, url in found.items()
    ]
    try:
        wait_until_ready(found["gateway"], processes)
        yield found
    finally:
        for process in processes:
            process.terminate()
        codes = {process.wait(timeout=10) for process in processes}
        # uvicorn ends its lifespan, then dies of the signal that it was sent.
        assert codes <= {0, -signal.SIGTERM}, "every service stops in good order on SIGTERM"


def wait_until_ready(url: str, processes: list[subprocess.Popen[bytes]]) -> None:
    deadline = time.monotonic() + READY_TIMEOUT_S
    while time.monotonic() < deadline:
        assert all(process.poll() is None for process in processes), "a service ended at once"
        with contextlib.suppress(httpx.TransportError):
            if httpx.get(f"{url}/health/ready").status_code == 200:
                return
        time.sleep(0.1)
    raise AssertionError("the services did not get ready")


def comparable(answer: dict[str, Any]) -> dict[str, Any]:
    """Leave out what may differ by contract: ids and timings."""
    return {key: answer[key] for key in answer if key not in ("request_id", "timings_ms")}


def test_the_network_gives_the_embedded_answer(
    urls: dict[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SPARGE_REASONING_KNOWLEDGE_DIR", str(tmp_path))
    body = sample_path("saucepan").read_bytes()
    headers = {"Content-Type": "application/x-npz"}
    with in_process(create_app()) as embedded, httpx.Client(timeout=60) as network:
        for question in QUESTIONS:
            here = embedded.request(
                "POST", "/grasp", params=question, content=body, headers=headers
            )
            there = network.post(
                f"{urls['gateway']}/grasp", params=question, content=body, headers=headers
            )
            assert here.status_code == there.status_code == 200, (here.text, there.text)
            assert comparable(here.json()) == comparable(there.json())


def test_the_request_id_reaches_every_stage(urls: dict[str, str]) -> None:
    response = httpx.post(
        f"{urls['gateway']}/grasp",
        params={"task": "cooking"},
        json={"points": []},
        headers={"X-Request-ID": "robot-7"},
        timeout=60,
    )
    error = response.json()["error"]
    assert (response.status_code, error["code"]) == (422, "empty_cloud")
    assert error["request_id"] == "robot-7"
    assert error["details"]["stage"] == "perception"
