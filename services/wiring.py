"""The composition root: the one place that knows all services.

A stage with a URL is called over the network; one without runs in this process, where
its messages are handed over as they are. Nothing else differs.
"""

from __future__ import annotations

import functools
import importlib
from collections.abc import AsyncIterator, Iterator
from contextlib import AsyncExitStack, asynccontextmanager, contextmanager
from typing import Any

import httpx
from fastapi import FastAPI

from services.gateway.app import create_app as create_gateway
from services.gateway.settings import STAGES, GatewaySettings
from shared.client import Sparge
from shared.service import LocalStage
from shared.service.exchange import IN_PROCESS
from shared.service.local import READY_TIMEOUT_S, in_process


def create_stage(name: str) -> FastAPI:
    """Return the application of one stage, with settings from the environment.

    Raises
    ------
    ImportError
        The stage's dependency group is not installed.
    """
    create: Any = importlib.import_module(f"services.{name}.app").create_app
    app: FastAPI = create()
    return app


def create_app(settings: GatewaySettings | None = None) -> FastAPI:
    """Return the whole backend: the gateway, and in this process every stage without a URL."""
    settings = settings or GatewaySettings()
    embedded = {name: create_stage(name) for name in STAGES if settings.stage_url(name) is None}
    gateway = create_gateway(
        settings,
        {name: functools.partial(LocalStage, name, app) for name, app in embedded.items()},
    )
    for stage in embedded.values():
        gateway.state.metrics.join(stage.state.metrics)
    alone = gateway.router.lifespan_context

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        async with AsyncExitStack() as stack:
            for stage in embedded.values():
                await stack.enter_async_context(stage.router.lifespan_context(stage))
            await stack.enter_async_context(alone(app))
            yield

    gateway.router.lifespan_context = lifespan
    return gateway


@contextmanager
def embedded(ready_timeout_s: float = READY_TIMEOUT_S) -> Iterator[Sparge]:
    """Run the whole backend in this process, ready when this yields, and speak to it.

    Raises
    ------
    StageUnavailable
        A stage cannot start, or takes longer than `ready_timeout_s` seconds.
    """
    with in_process(create_app(), ready_timeout_s) as client:
        yield Sparge(client.request)


@asynccontextmanager
async def in_this_process(
    settings: GatewaySettings | None = None,
) -> AsyncIterator[httpx.AsyncBaseTransport]:
    """Run the whole backend on this event loop; gives the transport to its gateway."""
    app = create_app(settings)
    async with app.router.lifespan_context(app):
        yield to_application(app)


def to_application(app: FastAPI) -> httpx.AsyncBaseTransport:
    """Return a transport into an application of this process; the caller logs its requests."""
    return httpx.ASGITransport(app=app, raise_app_exceptions=False, client=IN_PROCESS)
