"""Serve an application to a synchronous test, in this process or over a real socket."""

from __future__ import annotations

import contextlib
import socket
import threading
import time
from collections.abc import Iterator

import httpx
import uvicorn
from fastapi import FastAPI

from shared.service.local import LocalClient as Client
from shared.service.local import in_process

__all__ = ["Client", "free_ports", "in_process", "over_socket", "serving"]

READY_TIMEOUT_S = 120.0


@contextlib.contextmanager
def over_socket(app: FastAPI) -> Iterator[Client]:
    """Run `app` under uvicorn on a free port of the loopback; ready when this yields."""
    with serving(app) as url, httpx.Client(base_url=url, timeout=60) as http:
        client = Client(http.request)
        client.wait_until_ready(READY_TIMEOUT_S)
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


def free_ports(count: int) -> list[int]:
    """Return ports of the loopback that nothing listens on now."""
    with contextlib.ExitStack() as stack:
        held = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
        for each in held:
            stack.enter_context(each)
        return [each.getsockname()[1] for each in held]
