"""Every service in a process of its own, as in production; each can be killed and started."""

from __future__ import annotations

import contextlib
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import httpx

from services.gateway.settings import STAGES
from tests.support.processes import READY_TIMEOUT_S, start_service
from tests.support.serving import free_ports

SERVICES = (*STAGES, "gateway")


class Deployment:
    """Seven processes, each `uvicorn --factory services.NAME.app:create_app`.

    Parameters
    ----------
    knowledge : Path
        The folder of what is learned.
    **environment : str
        Further settings.

    Attributes
    ----------
    urls : dict
        Where each service is.
    """

    def __init__(self, knowledge: Path, **environment: str) -> None:
        ports = free_ports(len(SERVICES))
        self.urls = {
            name: f"http://127.0.0.1:{port}" for name, port in zip(SERVICES, ports, strict=True)
        }
        self._environment = {
            "SPARGE_REASONING_KNOWLEDGE_DIR": str(knowledge),
            **{f"SPARGE_GATEWAY_{name.upper()}_URL": self.urls[name] for name in STAGES},
            **environment,
        }
        self._processes: dict[str, subprocess.Popen[bytes]] = {}

    def start(self, name: str) -> None:
        """Start a service; it is not ready yet."""
        port = int(self.urls[name].rsplit(":", 1)[1])
        self._processes[name] = start_service(name, port, self._environment)

    def send(self, name: str, sent: signal.Signals) -> None:
        """Send a signal to a service."""
        self._processes[name].send_signal(sent)

    def kill(self, name: str) -> None:
        """End a service at once, as when memory runs out."""
        self._processes[name].kill()
        self._processes[name].wait()

    def wait_until_ready(self, name: str) -> None:
        """Return when `/health/ready` of a service answers 200."""
        deadline = time.monotonic() + READY_TIMEOUT_S
        while time.monotonic() < deadline:
            ended = [
                each for each, process in self._processes.items() if process.poll() is not None
            ]
            assert not ended, f"ended at once: {ended}"
            with contextlib.suppress(httpx.TransportError):
                if httpx.get(f"{self.urls[name]}/health/ready", timeout=10).status_code == 200:
                    return
            time.sleep(0.1)
        raise AssertionError(f"{name} did not get ready")

    def stop(self) -> None:
        """End all services in good order."""
        for process in self._processes.values():
            process.terminate()
        codes = {process.wait(timeout=10) for process in self._processes.values()}
        # uvicorn ends its lifespan, then dies of the signal that it was sent.
        assert codes <= {0, -signal.SIGTERM}, "every service stops in good order on SIGTERM"


@contextlib.contextmanager
def deployed(knowledge: Path, **environment: str) -> Iterator[Deployment]:
    """Start all services; they are ready when this yields."""
    deployment = Deployment(knowledge, **environment)
    try:
        for name in SERVICES:
            deployment.start(name)
        deployment.wait_until_ready("gateway")
        yield deployment
    finally:
        deployment.stop()
