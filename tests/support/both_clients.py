"""`Sparge` and `AsyncSparge` in the same tests: the latter is awaited here."""

from __future__ import annotations

import asyncio
import contextlib
import inspect
from collections.abc import Callable, Iterator
from typing import Any

import anyio.from_thread
import httpx

from shared.client import AsyncSparge, Sparge

Handler = Callable[[httpx.Request], httpx.Response]


class Awaited:
    """An `AsyncSparge` whose methods are called as those of a `Sparge`."""

    def __init__(self, sparge: AsyncSparge, portal: anyio.from_thread.BlockingPortal) -> None:
        self._sparge = sparge
        self._portal = portal

    def __getattr__(self, name: str) -> Any:
        method = getattr(self._sparge, name)
        assert inspect.iscoroutinefunction(method)

        def call(*given: Any, **named: Any) -> Any:
            async def run() -> Any:
                return await method(*given, **named)

            return self._portal.call(run)

        return call


@contextlib.contextmanager
def awaited(backend: Any = None, **options: Any) -> Iterator[Any]:
    """Yield an `AsyncSparge` to synchronous tests, on an event loop of its own thread."""
    with anyio.from_thread.start_blocking_portal() as portal:

        async def start() -> AsyncSparge:
            return AsyncSparge(backend, **options)

        sparge = portal.call(start)
        try:
            yield Awaited(sparge, portal)
        finally:
            portal.call(sparge.close)


@contextlib.contextmanager
def of_kind(kind: str, backend: Any = None, **options: Any) -> Iterator[Any]:
    """Yield a client of the kind `sync` or `async`."""
    if kind == "async":
        with awaited(backend, **options) as sparge:
            yield sparge
        return
    with Sparge(backend, **options) as sparge:
        yield sparge


def sending(kind: str, handle: Handler) -> Callable[..., Any]:
    """Return what sends requests of a client to a function, over httpx's own machinery."""
    transport = httpx.MockTransport(handle)
    base = "http://backend"
    if kind == "async":
        http = httpx.AsyncClient(transport=transport, base_url=base)
        return http.request
    return httpx.Client(transport=transport, base_url=base).request


def in_loop(send: Callable[..., httpx.Response]) -> Callable[..., Any]:
    """Return a blocking `send` as one to be awaited."""

    async def awaited_send(*given: Any, **named: Any) -> httpx.Response:
        return await asyncio.to_thread(send, *given, **named)

    return awaited_send
