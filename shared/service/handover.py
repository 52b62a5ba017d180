"""Calling a service of this process: the message itself is handed over, not its bytes.

Messages are frozen and their arrays read-only, so that nobody can tell the difference: the
same handler answers it when it is its turn, within the same deadline, with the same errors,
and it is counted, logged and traced as a request that came as HTTP is.
"""

from __future__ import annotations

import asyncio
import functools
import logging
import time
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from fastapi import FastAPI
from opentelemetry import trace

from shared.deadline import within
from shared.errors import InternalError, SpargeError
from shared.schemas.route import Route
from shared.service.admission import Admission
from shared.service.app import Health
from shared.service.client import as_of_stage, out_of_time, time_left
from shared.service.exchange import IN_PROCESS, NOTHING_SENT, Exchange
from shared.service.request_id import request_id
from shared.service.tracing import answering, calling
from shared.wire import Message

In = TypeVar("In", bound=Message)
Out = TypeVar("Out", bound=Message)

log = logging.getLogger("sparge")


class Handover:
    """Where a service of this process takes messages.

    Parameters
    ----------
    handlers : mapping
        The function that answers each route, in a thread.
    admission : Admission
        The service's queue.
    require_ready : callable
        Raises `StageUnavailable` before the service is warm.
    observe : callable
        Counts and logs an exchange.
    tracer : Tracer
        Makes the span of each.
    """

    def __init__(
        self,
        handlers: Mapping[Route[Any, Any], Callable[[Any], Any]],
        admission: Admission,
        require_ready: Callable[[], None],
        observe: Callable[[Exchange], None],
        tracer: trace.Tracer,
    ) -> None:
        self._handlers = handlers
        self._admission = admission
        self._require_ready = require_ready
        self._observe = observe
        self._tracer = tracer

    async def answer(self, route: Route[In, Out], message: In) -> Out:
        """Return the service's answer.

        Raises
        ------
        SpargeError
            What the service refuses it with; `InternalError`, logged, where it broke.
        """
        started, status, code = time.perf_counter(), NOTHING_SENT, None
        with answering(self._tracer, route) as span:
            try:
                self._require_ready()
                work = functools.partial(self._handlers[route], message)
                answer: Out = await self._admission.in_thread(work)
                status = 200
                return answer
            except Exception as error:
                refusal = error if isinstance(error, SpargeError) else None
                if refusal is None:
                    log.exception("unhandled error in request %s", request_id.get())
                    refusal = InternalError(
                        "an internal error; the log has it under this request id"
                    )
                status, code = refusal.status, refusal.code
                raise refusal from None
            finally:
                span.set_attribute("http.response.status_code", status)
                seconds = time.perf_counter() - started
                self._observe(
                    Exchange(
                        *(route.method, route.path, status, seconds, 0, 0),
                        client=IN_PROCESS[0],
                        error_code=code,
                    )
                )


class LocalStage:
    """Calls one service of this process; as `StageClient` in every other respect.

    Parameters
    ----------
    service : str
        Its name, for messages.
    app : FastAPI
        Made by `create_service`; whoever made it runs its lifespan.
    tracer : Tracer, optional
        Makes a span of each call.
    """

    def __init__(self, service: str, app: FastAPI, tracer: trace.Tracer | None = None) -> None:
        self.service = service
        self._app = app
        self._tracer = tracer or trace.get_tracer("sparge")

    async def call(self, route: Route[In, Out], request: In, timeout_s: float) -> Out:
        """Hand over `request`, return the answer.

        Raises
        ------
        SpargeError
            What the service answered with, for errors of the input.
        StageUnavailable
            It is not ready, or failed.
        DeadlineExceeded
            No answer within `timeout_s` seconds, or by the deadline of the request that is
            being answered.
        """
        left_s = time_left(self.service, timeout_s)
        handover: Handover = self._app.state.handover
        try:
            with calling(self._tracer, route, self.service), within(left_s):
                async with asyncio.timeout(left_s):
                    return await handover.answer(route, request)
        except TimeoutError:
            raise out_of_time(self.service) from None
        except SpargeError as error:
            raise as_of_stage(self.service, error) from None

    async def health(self, timeout_s: float) -> Health:
        """Ask whether it is ready."""
        try:
            async with asyncio.timeout(timeout_s):
                health: Health = await self._app.state.ready()
                return health
        except TimeoutError:
            return Health(
                status="failed", service=self.service, details={"error": "does not answer"}
            )

    async def close(self) -> None:
        """Do nothing: there is no connection."""
