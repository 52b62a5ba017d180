"""Each service alone under uvicorn, the gateway pointed at them: the embedded answer."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from services.gateway.settings import STAGES
from services.wiring import create_app
from tests.support.processes import served, wait_until_ready
from tests.support.samples import sample_path
from tests.support.serving import in_process

QUESTIONS = [
    {"task": "cooking", "reasoning": "v1"},
    {"task": "cooking", "reasoning": "v2", "seed": "7"},
    {"task": "handover", "reasoning": "v2"},
    {"task": "hammering", "reasoning": "v2"},
]


@pytest.fixture(scope="module")
def gateway(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Seven processes, each `uvicorn --factory services.NAME.app:create_app`; the gateway's URL."""
    knowledge = str(tmp_path_factory.mktemp("knowledge"))
    with served(STAGES, {"SPARGE_REASONING_KNOWLEDGE_DIR": knowledge}) as stages:
        urls = {f"SPARGE_GATEWAY_{name.upper()}_URL": stages[name].url for name in STAGES}
        with served(["gateway"], urls) as first:
            wait_until_ready(first["gateway"], stages)
            yield first["gateway"].url


def comparable(answer: dict[str, Any]) -> dict[str, Any]:
    """Leave out what may differ by contract: ids and timings."""
    return {key: answer[key] for key in answer if key not in ("request_id", "timings_ms")}


def test_the_network_gives_the_embedded_answer(
    gateway: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SPARGE_REASONING_KNOWLEDGE_DIR", str(tmp_path))
    body = sample_path("saucepan").read_bytes()
    headers = {"Content-Type": "application/x-npz"}
    with in_process(create_app()) as embedded, httpx.Client(timeout=60) as network:
        for question in QUESTIONS:
            here = embedded.request(
                "POST", "/grasp", params=question, content=body, headers=headers
            )
            there = network.post(f"{gateway}/grasp", params=question, content=body, headers=headers)
            assert here.status_code == there.status_code == 200, (here.text, there.text)
            assert comparable(here.json()) == comparable(there.json())


def test_the_request_id_reaches_every_stage(gateway: str) -> None:
    response = httpx.post(
        f"{gateway}/grasp",
        params={"task": "cooking"},
        json={"points": []},
        headers={"X-Request-ID": "robot-7"},
        timeout=60,
    )
    error = response.json()["error"]
    assert (response.status_code, error["code"]) == (422, "empty_cloud")
    assert error["request_id"] == "robot-7"
    assert error["details"]["stage"] == "perception"
