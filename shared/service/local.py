"""Calling an application of this process from synchronous code."""

from __future__ import annotations

import contextlib
import functools
import time
from collections.abc import Callable, Iterator
from typing import Any

import anyio.from_thread
import httpx
from fastapi import FastAPI

from shared.errors import StageUnavailable


class LocalClient:
    """Sends requests somewhere: to an application here, or through an `httpx.Client`."""

    def __init__(self, send: Callable[..., httpx.Response]) -> None:
        self._send = send

    def request(self, method: str, path: str, **options: Any) -> httpx.Response:
        """As `httpx.Client.request`."""
        return self._send(method, path, **options)

    def wait_until_ready(self, timeout_s: float) -> None:
        """Return when `/health/ready` answers 200.

        Raises
        ------
        StageUnavailable
            Something cannot start, or takes longer than `timeout_s`; says what.
        """
        deadline = time.monotonic() + timeout_s
        while True:
            response = self.request("GET", "/health/ready")
            if response.status_code == 200:
                return
            health = response.json()
            if health.get("status") == "failed" or time.monotonic() > deadline:
                waiting = "; ".join(f"{k}: {v}" for k, v in health.get("details", {}).items())
                raise StageUnavailable(f"{health.get('service')} is not ready: {waiting}")
            time.sleep(0.02)


READY_TIMEOUT_S = 900.0
"""A first start compiles every kernel: two to three minutes on two idle cores, and several times
that on a busy machine. What cannot start says so before."""


@contextlib.contextmanager
def in_process(app: FastAPI, ready_timeout_s: float = READY_TIMEOUT_S) -> Iterator[LocalClient]:
    """Run `app` with its lifespan on an event loop of its own thread; ready when this yields."""
    with anyio.from_thread.start_blocking_portal() as portal:
        transport = httpx.ASGITransport(app=app, raise_app_exceptions=False)
        http = httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1", timeout=None)

        def send(method: str, path: str, **options: Any) -> httpx.Response:
            return portal.call(functools.partial(http.request, method, path, **options))

        with portal.wrap_async_context_manager(app.router.lifespan_context(app)):
            client = LocalClient(send)
            client.wait_until_ready(ready_timeout_s)
            yield client
            portal.call(http.aclose)
