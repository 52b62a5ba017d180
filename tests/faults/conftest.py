"""A gateway with every stage behind a socket that can be made to fail; it is never restarted."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import httpx
import pytest

from services.gateway.app import create_app
from services.gateway.settings import STAGES, GatewaySettings
from services.wiring import create_stage
from tests.faults.faulty import FaultyStage
from tests.support.asking import REQUESTS
from tests.support.serving import in_process, serving

DEADLINE_S = 2.0
SLACK_S = 2.0
"""How much later an answer may be, on a machine that does other things as well."""


@dataclass(frozen=True)
class Backend:
    """The gateway, and what is behind it."""

    http: httpx.Client
    stages: dict[str, FaultyStage]

    def ask(self, stage: str) -> tuple[httpx.Response, float]:
        """Send a request that gets to `stage`; return the answer and the seconds it took."""
        path, body = REQUESTS[stage]
        started = time.monotonic()
        response = self.http.post(path, json=body)
        return response, time.monotonic() - started

    def works(self, stage: str) -> None:
        """Assert that the next request to it is answered."""
        response, _ = self.ask(stage)
        assert response.status_code == 200, response.text


@pytest.fixture(scope="package")
def backend(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Backend]:
    with contextlib.ExitStack() as stack:
        environment = stack.enter_context(pytest.MonkeyPatch.context())
        knowledge = str(tmp_path_factory.mktemp("knowledge"))
        environment.setenv("SPARGE_REASONING_KNOWLEDGE_DIR", knowledge)
        stages = {}
        for name in STAGES:
            stages[name] = FaultyStage(stack.enter_context(in_process(create_stage(name))))
            stack.callback(stages[name].stop)
        urls: dict[str, Any] = {f"{name}_url": stage.url for name, stage in stages.items()}
        settings = GatewaySettings(
            **urls, deadline_s=DEADLINE_S, execution_deadline_s=DEADLINE_S, samples=20
        )
        url = stack.enter_context(serving(create_app(settings)))
        http = stack.enter_context(httpx.Client(base_url=url, timeout=60))
        backend = Backend(http, stages)
        for stage in ("perception", "execution"):  # what is compiled or started at first use
            for _ in range(20):
                if backend.ask(stage)[0].status_code == 200:
                    break
        yield backend
