"""Services as processes of their own, each started as an image starts it."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import httpx

from tests.support.serving import free_ports

READY_TIMEOUT_S = 240.0
STOP_TIMEOUT_S = 10.0
CHECKOUT = Path(__file__).parents[2]


@dataclass(frozen=True)
class Served:
    """A service that runs alone."""

    url: str
    process: subprocess.Popen[bytes]


@contextlib.contextmanager
def served(names: Sequence[str], environment: Mapping[str, str]) -> Iterator[dict[str, Served]]:
    """Run `uvicorn --factory services.NAME.app:create_app` for each; they may still warm up.

    Each has to stop in good order on SIGTERM, or an AssertionError is raised.

    Parameters
    ----------
    names : sequence of str
        Of the services' packages.
    environment : mapping
        Added to this process's.
    """
    running = {
        name: Served(f"http://127.0.0.1:{port}", start_service(name, port, environment))
        for name, port in zip(names, free_ports(len(names)), strict=True)
    }
    try:
        yield running
    finally:
        for each in running.values():
            each.process.terminate()
        codes = {_ended(each.process) for each in running.values()}
        # uvicorn ends its lifespan, then dies of the signal that it was sent.
        assert codes <= {0, -signal.SIGTERM}, f"not every service stopped in good order: {codes}"


def wait_until_ready(gateway: Served, stages: Mapping[str, Served]) -> None:
    """Return once the gateway says that every stage is warm."""
    deadline = time.monotonic() + READY_TIMEOUT_S
    while time.monotonic() < deadline:
        for name, each in {"gateway": gateway, **stages}.items():
            assert each.process.poll() is None, f"{name} ended at once"
        with contextlib.suppress(httpx.TransportError):
            if httpx.get(f"{gateway.url}/health/ready").status_code == 200:
                return
        time.sleep(0.1)
    raise AssertionError("the services did not get ready")


def _ended(process: subprocess.Popen[bytes]) -> int:
    """Return the exit status; a process that does not end in time is killed."""
    try:
        return process.wait(timeout=STOP_TIMEOUT_S)
    except subprocess.TimeoutExpired:
        process.kill()
        return process.wait()


def start_service(name: str, port: int, environment: Mapping[str, str]) -> subprocess.Popen[bytes]:
    """Start a service on a port of the loopback; it may still warm up."""
    return subprocess.Popen(
        [
            *(sys.executable, "-m", "uvicorn", "--log-level=warning"),
            f"--port={port}",
            *("--factory", f"services.{name}.app:create_app"),
        ],
        env={**os.environ, **environment},
        cwd=CHECKOUT,
    )
