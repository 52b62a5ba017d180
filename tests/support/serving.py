"""Serve an application to a synchronous test, in this process or over a real socket."""

from __future__ import annotations

import contextlib
import functools
import socket
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import anyio.from_thread
import httpx
import uvicorn
from fastapi import FastAPI

READY_TIMEOUT_S = 120.0


class Client:
    """Sends one request to the application under test."""

    def __init__(self, send: Callable[..., httpx.Response]) -> None:
        self._send = send

    def request(self, method: str, path: str, **options: Any) -> httpx.Response:
        """As `httpx.Client.request`."""
        return self._send(method, path, **options)


@contextlib.contextmanager
def in_process(app: FastAPI) -> Iterator[Client]:
    """Run `app` with its lifespan over ASGI; ready when this yields."""

    with anyio.from_thread.start_blocking_portal() as portal:
        transport = httpx.ASGITransport(app=app, raise_app_exceptions=False)
        http = httpx.AsyncClient(transport=transport, base_url="http://service", timeout=None)

        def send(method: str, path: str, **options: Any) -> httpx.Response:
            return portal.call(functools.partial(http.request, method, path, **options))

        with portal.wrap_async_context_manager(app.router.lifespan_context(app)):
            client = Client(send)
            _wait_until_ready(client)
            yield client
            portal.call(http.aclose)


@contextlib.contextmanager
def over_socket(app: FastAPI) -> Iterator[Client]:
    """Run `app` under uvicorn on a free port of the loopback; ready when this yields."""
    with serving(app) as url, httpx.Client(base_url=url, timeout=60) as http:
        client = Client(http.request)
        _wait_until_ready(client)
        yield client


@contextlib.contextmanager
def serving(app: FastAPI) -> Iterator[str]:
    """Run `app` under uvicorn in a thread and yield its URL; it may still be warming up."""
    listener = socket.create_server(("127.0.0.1", 0))
    config = uvicorn.Config(app, log_level="warning", lifespan="on", timeout_graceful_shutdown=5)
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]}, daemon=True)
    thread.start()
    while not server.started and thread.is_alive():
        time.sleep(0.01)
    try:
        yield f"http://127.0.0.1:{listener.getsockname()[1]}"
    finally:
        server.should_exit = True
        thread.join(timeout=10)
        listener.close()


def _wait_until_ready(client: Client) -> None:
    deadline = time.monotonic() + READY_TIMEOUT_S
    while True:
        response = client.request("GET", "/health/ready")
        if response.status_code == 200:
            return
        if response.json().get("status") == "failed" or time.monotonic() > deadline:
            raise RuntimeError(f"the service does not get ready: {response.text}")
        time.sleep(0.02)
