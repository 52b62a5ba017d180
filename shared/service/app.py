"""The application that every service is: health, version, metrics, errors, limits."""

from __future__ import annotations

from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from typing import Any, Literal

from fastapi import FastAPI
from fastapi.responses import JSONResponse, Response
from opentelemetry import trace
from pydantic import BaseModel

from shared import __version__
from shared.service.admission import Admission
from shared.service.context import Guard, RequestContext
from shared.service.envelope import ErrorBodyOf, ErrorEnvelope, install_error_handlers
from shared.service.exchange import Exchange
from shared.service.logs import configure_logging, log_exchange
from shared.service.memory import keep_freed_memory
from shared.service.telemetry import Metrics
from shared.service.tracing import exporting, telemetry, tracer_provider
from shared.settings import ServiceSettings

GUARDED: dict[int | str, dict[str, Any]] = {
    401: {"model": ErrorEnvelope, "description": "A key or secret is wanted, or another one"},
    403: {"model": ErrorEnvelope, "description": "The key does not open this"},
}
"""Answers of what is not open to everybody."""
Lifespan = Callable[[FastAPI], AbstractAsyncContextManager[None]]


class Health(BaseModel):
    """Whether a service can work, and if not, what it waits for."""

    status: Literal["alive", "ready", "starting", "failed"]
    service: str
    details: dict[str, str] = {}


class Version(BaseModel):
    """Which build answers."""

    service: str
    version: str


def create_base(
    name: str,
    summary: str,
    settings: ServiceSettings,
    *,
    lifespan: Lifespan,
    ready: Callable[[], Awaitable[Health]],
    guard: Guard,
    error_body: ErrorBodyOf | None = None,
) -> FastAPI:
    """Return a FastAPI application with what all services share.

    Parameters
    ----------
    name : str
        The service's name, as in its package.
    summary : str
        One line for the OpenAPI page.
    settings : ServiceSettings
        Limits.
    lifespan : callable
        Entered before the first request, left after the last.
    ready : callable
        Asked by `/health/ready`; only status `ready` answers 200.
    guard : callable
        Raises the error of a request that may not pass.
    error_body : callable, optional
        Writes the body of an error, where that is not the envelope on every path.
    """

    @asynccontextmanager
    async def running(app: FastAPI) -> AsyncIterator[None]:
        keep_freed_memory()
        async with exporting(), lifespan(app):
            yield

    configure_logging()
    provider = tracer_provider(name)
    app = FastAPI(
        title=f"SPaRGE {name}",
        summary=summary,
        version=__version__,
        lifespan=running,
        telemetry=telemetry(provider),
    )
    metrics = Metrics(name)
    app.state.metrics = metrics
    app.state.error_body = error_body
    app.state.admission = Admission(name, settings)
    metrics.watch(app.state.admission)
    app.state.tracer = trace.get_tracer("sparge", tracer_provider=provider)

    def observe(exchange: Exchange) -> None:
        metrics.observe(exchange)
        log_exchange(name, exchange)

    app.state.observe = observe
    app.state.ready = ready
    app.add_middleware(RequestContext, settings=settings, observe=observe, guard=guard)
    install_error_handlers(app)

    @app.get("/health/live", tags=["operations"], summary="The process answers")
    async def live() -> Health:
        return Health(status="alive", service=name)

    @app.get(
        "/health/ready",
        tags=["operations"],
        summary="Warm and able to work",
        responses={503: {"model": Health, "description": "Not yet, or not any more"}},
        response_model=Health,
    )
    async def is_ready() -> Response:
        health = await ready()
        code = 200 if health.status == "ready" else 503
        return JSONResponse(health.model_dump(), status_code=code)

    @app.get("/version", tags=["operations"], summary="Which build answers", responses=GUARDED)
    async def version() -> Version:
        return Version(service=name, version=app.version)

    @app.get(
        "/metrics",
        tags=["operations"],
        summary="Prometheus metrics",
        response_class=Response,
        responses=GUARDED,
    )
    async def expose() -> Response:
        return metrics.expose()

    return app
