"""Each service alone under uvicorn, the gateway pointed at them: the embedded answer.

And each of them killed in mid-request, started again, and the gateway as if nothing had been.
"""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import httpx
import pytest

from services.gateway.settings import STAGES
from services.wiring import create_app
from tests.support.asking import REQUESTS, failed
from tests.support.deployment import Deployment, deployed
from tests.support.samples import sample_path
from tests.support.serving import in_process

QUESTIONS = [
    {"task": "cooking", "reasoning": "v1"},
    {"task": "cooking", "reasoning": "v2", "seed": "7"},
    {"task": "handover", "reasoning": "v2"},
    {"task": "hammering", "reasoning": "v2"},
]


@pytest.fixture(scope="module")
def deployment(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Deployment]:
    with deployed(tmp_path_factory.mktemp("knowledge")) as running:
        yield running


def comparable(answer: dict[str, Any]) -> dict[str, Any]:
    """Leave out what may differ by contract: ids and timings."""
    return {key: answer[key] for key in answer if key not in ("request_id", "timings_ms")}


def test_the_network_gives_the_embedded_answer(
    deployment: Deployment, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
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
                f"{deployment.urls['gateway']}/grasp",
                params=question,
                content=body,
                headers=headers,
            )
            assert here.status_code == there.status_code == 200, (here.text, there.text)
            assert comparable(here.json()) == comparable(there.json())


def test_the_request_id_reaches_every_stage(deployment: Deployment) -> None:
    response = httpx.post(
        f"{deployment.urls['gateway']}/grasp",
        params={"task": "cooking"},
        json={"points": []},
        headers={"X-Request-ID": "robot-7"},
        timeout=60,
    )
    error = response.json()["error"]
    assert (response.status_code, error["code"]) == (422, "empty_cloud")
    assert error["request_id"] == "robot-7"
    assert error["details"]["stage"] == "perception"


@pytest.mark.slow
def test_each_stage_killed_in_mid_request_is_named_and_recovers(deployment: Deployment) -> None:
    """The gateway is never restarted."""
    with (
        httpx.Client(base_url=deployment.urls["gateway"], timeout=60) as http,
        ThreadPoolExecutor(1) as pool,
    ):
        for stage in STAGES:
            path, body = REQUESTS[stage]
            assert http.post(path, json=body).status_code == 200
            deployment.send(stage, signal.SIGSTOP)  # so that it is surely still at work
            waiting = pool.submit(http.post, path, json=body)
            time.sleep(1.0)  # it has got there
            assert not waiting.done()
            killed_at = time.monotonic()
            deployment.kill(stage)
            failed(waiting.result(), 503, "stage_unavailable", stage)
            assert time.monotonic() - killed_at < 5
            while_down = http.post(path, json=body)
            assert "cannot be reached" in failed(while_down, 503, "stage_unavailable", stage)
            assert http.get("/health/ready").json()["details"].keys() == {stage}
            deployment.start(stage)
            deployment.wait_until_ready("gateway")
            assert http.post(path, json=body).status_code == 200
