"""Asking a deployed backend, and what that costs each of its processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx

from services.gateway.settings import STAGES
from shared.schemas.answer import GraspAnswer
from shared.schemas.execution import ExecuteRequest
from shared.wire import JSON, NPZ
from tests.bench.scaling.questions import Question
from tests.bench.scaling.relay import Passed, relays
from tests.bench.scaling.usage import usage
from tests.support.processes import Served, served, wait_until_ready

GATEWAY = "gateway"
SERVICES = (GATEWAY, *STAGES)


@dataclass(frozen=True)
class Cost:
    """What requests of one kind cost a service, for each of them on average.

    Attributes
    ----------
    cpu_ms : float
        Processor time of the service's processes.
    received_kb, answered_kb : float
        10^3 bytes to the service and from it, HTTP's own lines included.
    connections : float
        That were opened to it.
    """

    cpu_ms: float
    received_kb: float
    answered_kb: float
    connections: float


@dataclass(frozen=True)
class Backend:
    """Seven processes, with a relay before each."""

    processes: Mapping[str, Served]
    passed: Mapping[str, Passed]

    @property
    def url(self) -> str:
        """Of the gateway, or rather of the relay before it."""
        return self.passed[GATEWAY].url

    def costs(self, ask: Callable[[], int]) -> dict[str, Cost]:
        """Return what `ask`, which says how many requests it made, costs each service."""
        before = {name: self._reading(name) for name in SERVICES}
        count = ask()
        after = {name: self._reading(name) for name in SERVICES}
        return {
            name: Cost(*((b - a) / count for a, b in zip(before[name], after[name], strict=True)))
            for name in SERVICES
        }

    def peak_mb(self) -> dict[str, float]:
        """Return the most memory that each service has held, 10^6 bytes."""
        return {name: usage(self.processes[name].process.pid).peak_mb for name in SERVICES}

    def _reading(self, name: str) -> tuple[float, float, float, float]:
        passed = self.passed[name]
        cpu_s = usage(self.processes[name].process.pid).cpu_s
        return 1e3 * cpu_s, passed.sent / 1e3, passed.answered / 1e3, float(passed.connections)


@contextmanager
def deployed(knowledge: Path, environment: Mapping[str, str]) -> Iterator[Backend]:
    """Run every service alone, warm.

    Parameters
    ----------
    knowledge : Path
        Where reasoning keeps what it learns.
    environment : mapping
        Further settings.
    """
    settings = {"SPARGE_REASONING_KNOWLEDGE_DIR": str(knowledge), **environment}
    with (
        served(STAGES, settings) as stages,
        relays({name: each.url for name, each in stages.items()}) as inner,
    ):
        urls = {f"SPARGE_GATEWAY_{name.upper()}_URL": inner[name].url for name in STAGES}
        with (
            served([GATEWAY], {**settings, **urls}) as first,
            relays({GATEWAY: first[GATEWAY].url}) as outer,
        ):
            wait_until_ready(first[GATEWAY], stages)
            yield Backend({**stages, **first}, {**inner, **outer})


def grasp(http: httpx.Client, question: Question) -> GraspAnswer:
    """Ask POST /grasp; the answer is JSON.

    Raises
    ------
    RuntimeError
        It is an error.
    """
    answer = http.post(
        "/grasp",
        params={"task": question.task},
        content=question.body,
        headers={"Content-Type": NPZ, "Accept": JSON},
    )
    return GraspAnswer.model_validate_json(_good(answer))


def execution_of(answer: GraspAnswer) -> dict[str, Any]:
    """Return the body of POST /execute for the best grasp on what was recovered."""
    best = answer.grasps[0]
    request = ExecuteRequest(
        pose=best.pose,
        width=best.width,
        primitives=tuple(each.parameters for each in answer.primitives),
        plane=answer.scene.plane,
        up=None if answer.scene.plane else answer.scene.up,
    )
    return request.model_dump(mode="json", exclude_none=True)


def execute(http: httpx.Client, bodies: Sequence[dict[str, Any]]) -> int:
    """Ask POST /execute for each; return how many."""
    for body in bodies:
        _good(http.post("/execute", json=body))
    return len(bodies)


def _good(answer: httpx.Response) -> bytes:
    if answer.status_code != 200:
        raise RuntimeError(f"{answer.request.url} answered {answer.status_code}: {answer.text}")
    return answer.content
