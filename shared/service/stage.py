"""A stage: message in, message out, served from the same `Route` that the client calls."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from fastapi import FastAPI, Request
from fastapi.responses import Response
from starlette.concurrency import run_in_threadpool

from shared.errors import StageUnavailable
from shared.schemas.route import Route
from shared.service.app import Health, create_base
from shared.service.openapi import describe
from shared.settings import ServiceSettings
from shared.wire import JSON, NPZ, Message, decode, encode
from shared.wire.codec import validate

In = TypeVar("In", bound=Message)
Out = TypeVar("Out", bound=Message)

log = logging.getLogger("sparge")


@dataclass(frozen=True)
class Binding(Generic[In, Out]):
    """A route and the function that answers it."""

    route: Route[In, Out]
    handler: Callable[[In], Out]


def bind(route: Route[In, Out], handler: Callable[[In], Out]) -> Binding[In, Out]:
    """Say which function answers `route`; it runs in a worker thread, several at once."""
    return Binding(route, handler)


class WarmUp:
    """Runs a stage's warm-up once, in the background, and remembers how it went."""

    def __init__(self, service: str, work: Callable[[], None] | None) -> None:
        self._service = service
        self._work = work
        self._health = Health(status="starting", service=service)

    async def run(self) -> None:
        """Do the work; a failure is remembered and logged, not raised."""
        try:
            if self._work is not None:
                await run_in_threadpool(self._work)
            self._health = Health(status="ready", service=self._service)
        except Exception as error:
            log.exception("%s cannot start", self._service)
            self._health = Health(
                status="failed", service=self._service, details={"error": str(error)}
            )

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
    warm_up: Callable[[], None] | None = None,
    close: Callable[[], None] | None = None,
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
    close : callable, optional
        Called at shutdown.
    """
    warm = WarmUp(name, warm_up)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        task = asyncio.create_task(warm.run())
        try:
            yield
        finally:
            await task
            if close is not None:
                await run_in_threadpool(close)

    app = create_base(name, summary, settings, lifespan=lifespan, ready=warm.health)
    for binding in handlers:
        _serve(app, binding, settings, warm)
    describe(app, [binding.route for binding in handlers])
    return app


def _serve(
    app: FastAPI, binding: Binding[Any, Any], settings: ServiceSettings, warm: WarmUp
) -> None:
    route = binding.route

    def answer(body: bytes, media_type: str, path: dict[str, Any], accept: str) -> Response:
        if route.method == "POST":
            request = decode(route.request, body, media_type, settings.max_unpacked_bytes)
        else:
            request = validate(route.request, path)
        chosen = NPZ if NPZ in accept else JSON
        return Response(encode(binding.handler(request), chosen), media_type=chosen)

    async def endpoint(request: Request) -> Response:
        warm.require()
        return await run_in_threadpool(
            answer,
            await request.body(),
            request.headers.get("content-type", JSON),
            dict(request.path_params),
            request.headers.get("accept", JSON),
        )

    app.add_api_route(
        route.path,
        endpoint,
        methods=[route.method],
        summary=route.summary,
        name=f"{route.method} {route.path}",
        operation_id=f"{route.method.lower()}_{route.path.strip('/').replace('/', '_')}",
        response_class=Response,
        include_in_schema=True,
    )
