"""Answering a request for grasps, whatever protocol it came in: its turn, the chain, its traces."""

from __future__ import annotations

import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass

import numpy as np
from fastapi import Request
from fastapi.responses import Response
from numpy.typing import NDArray
from opentelemetry import trace

from services.gateway import answer
from services.gateway.memory import Memory
from services.gateway.metrics import GraspMetrics
from services.gateway.pipeline import Outcome, Pipeline
from services.gateway.request import GraspParameters, GraspRequest
from services.gateway.settings import GatewaySettings
from shared.deadline import within
from shared.schemas.answer import GraspAnswer
from shared.service.admission import Admission
from shared.service.request_id import request_id
from shared.service.server_timing import SERVER_TIMING, server_timing

Parse = Callable[[Request], Awaitable[GraspRequest]]


@dataclass(frozen=True)
class Answered:
    """What is to be written down, and what was asked."""

    parameters: GraspParameters
    answer: GraspAnswer
    outcome: Outcome

    def arrays(self) -> dict[str, NDArray[np.generic]]:
        """Return the contract's arrays: per INPUT point, the primitives, the grasps."""
        return answer.arrays(self.answer, self.outcome)


Write = Callable[[Answered], Awaitable[Response]]


class Grasping:
    """Takes requests for grasps.

    Parameters
    ----------
    pipeline : Pipeline
    settings : GatewaySettings
    admission : Admission
        The gateway's queue.
    memory : Memory
        Where explanations are kept.
    metrics : GraspMetrics
    """

    def __init__(
        self,
        pipeline: Pipeline,
        settings: GatewaySettings,
        admission: Admission,
        memory: Memory,
        metrics: GraspMetrics,
    ) -> None:
        self._pipeline, self._settings = pipeline, settings
        self._admission, self._memory, self._metrics = admission, memory, metrics

    async def respond(self, request: Request, parse: Parse, write: Write) -> Response:
        """Parse a request, answer it and write the answer when it is its turn, in its time.

        Raises
        ------
        SpargeError
            Whatever stands in the way.
        """
        with within(self._settings.deadline_s):
            await request.body()  # who sends slowly takes no place
            async with self._admission.turn():
                return await self._answer(request, parse, write)

    async def _answer(self, request: Request, parse: Parse, write: Write) -> Response:
        started = time.perf_counter()
        parsed = await parse(request)
        parsing_ms = 1e3 * (time.perf_counter() - started)
        span = trace.get_current_span()
        span.set_attribute("sparge.task", parsed.parameters.task)
        span.set_attribute("sparge.reasoning", parsed.parameters.reasoning)
        outcome = await self._pipeline.run(parsed)
        timings_ms = {
            "parsing": parsing_ms,
            **outcome.timings_ms,
            "total": 1e3 * (time.perf_counter() - started),
        }
        composed = answer.compose(outcome, parsed, self._settings, request_id.get(), timings_ms)
        self._memory.keep(composed)
        self._metrics.answered(
            composed.reasoning, composed.found, composed.reason, len(composed.grasps)
        )
        span.set_attribute("sparge.found", composed.found)
        response = await write(Answered(parsed.parameters, composed, outcome))
        response.headers[SERVER_TIMING] = server_timing(timings_ms)
        return response
