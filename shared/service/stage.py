"""A stage: message in, message out, served from the same `Route` that the client calls."""

from __future__ import annotations

import asyncio
import logging
import threading
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from fastapi import FastAPI
from starlette.concurrency import run_in_threadpool

from shared.errors import StageUnavailable
from shared.schemas.route import Route
from shared.service.app import Health, create_base
from shared.service.handover import Handover
from shared.service.openapi import describe
from shared.service.secret import SecretGuard
from shared.service.serve import serve_work
from shared.settings import ServiceSettings
from shared.wire import Message

In = TypeVar("In", bound=Message)
Out = TypeVar("Out", bound=Message)

log = logging.getLogger("sparge")

AFTERWARDS_S = 5.0
"""Seconds between a stage's being ready and its further warm-up."""


@dataclass(frozen=True)
class Binding(Generic[In, Out]):
    """A route and the function that answers it."""

    route: Route[In, Out]
    handler: Callable[[In], Out]


def bind(route: Route[In, Out], handler: Callable[[In], Out]) -> Binding[In, Out]:
    """Say which function answers `route`.

    It runs in a worker thread, as many at once as the settings say. One that takes long
    asks `shared.deadline.check_deadline` between its steps.
    """
    return Binding(route, handler)


class WarmUp:
    """Runs a stage's warm-up once, in the background, and remembers how it went."""

    def __init__(
        self,
        service: str,
        work: Callable[[], object] | None,
        afterwards: Callable[[], object] | None,
    ) -> None:
        self._service = service
        self._work = work
        self._afterwards = afterwards
        self._health = Health(status="starting", service=service)

    async def run(self) -> None:
        """Do the work; a failure is remembered and logged, not raised."""
        try:
            if self._work is not None:
                await run_in_threadpool(self._work)
            self._health = Health(status="ready", service=self._service)
        except Exception as error:
            self._failed(error)

    async def run_afterwards(self, stopping: asyncio.Event) -> None:
        """Once ready, wait a while, then do what is left: it is not to delay the first requests.

        Nothing more is begun once `stopping` is set, and nobody waits for what was: it may
        compile for a minute, and a service has to stop within seconds.
        """
        await self.run()
        if self._afterwards is None or self._health.status != "ready":
            return
        try:
            await asyncio.wait_for(stopping.wait(), AFTERWARDS_S)
        except TimeoutError:
            threading.Thread(target=self._do_afterwards, name="warm-up", daemon=True).start()

    def _do_afterwards(self) -> None:
        assert self._afterwards is not None
        try:
            self._afterwards()
        except Exception as error:
            self._failed(error)

    def _failed(self, error: Exception) -> None:
        log.exception("%s cannot start", self._service)
        self._health = Health(status="failed", service=self._service, details={"error": str(error)})

    async def health(self) -> Health:
        return self._health

    def require(self) -> None:
        """Raise `StageUnavailable` unless the stage is warm."""
        if self._health.status != "ready":
            why = self._health.details.get("error", "still warming up")
            raise StageUnavailable(
                f"the stage {self._service} is not ready: {why}", stage=self._service
            )


def create_service(
    name: str,
    summary: str,
    settings: ServiceSettings,
    handlers: Sequence[Binding[Any, Any]],
    *,
    warm_up: Callable[[], object] | None = None,
    afterwards: Callable[[], object] | None = None,
    close: Callable[[], object] | None = None,
) -> FastAPI:
    """Return the application of one stage.

    Parameters
    ----------
    name, summary : str
        The service's name and one line on what it does.
    settings : ServiceSettings
        Limits.
    handlers : sequence of Binding
        What it serves. Every route accepts and answers JSON and npz.
    warm_up : callable, optional
        Compiles, loads, connects; `/health/ready` turns 200 after it, and no
        route answers before.
    afterwards : callable, optional
        Warms up what few requests need, some seconds after the service is ready; those
        that come before it is done take longer.
    close : callable, optional
        Called at shutdown.
    """
    warm = WarmUp(name, warm_up, afterwards)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        stopping = asyncio.Event()
        task = asyncio.create_task(warm.run_afterwards(stopping))
        try:
            yield
        finally:
            stopping.set()
            await task
            if close is not None:
                await run_in_threadpool(close)

    app = create_base(
        name,
        summary,
        settings,
        lifespan=lifespan,
        ready=warm.health,
        guard=SecretGuard(settings.stage_secret),
    )
    admission = app.state.admission
    for binding in handlers:
        serve_work(app, binding.route, binding.handler, settings, admission, warm.require)
    app.state.handover = Handover(
        {binding.route: binding.handler for binding in handlers},
        admission,
        warm.require,
        app.state.observe,
        app.state.tracer,
    )
    describe(app, [binding.route for binding in handlers])
    return app
