"""The backend that is put under load, and how much memory it holds."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx

from tests.support.serving import free_ports

Memory = Callable[[], float]
"""Returns megabytes."""

READY_S = 900.0


@contextlib.contextmanager
def embedded() -> Iterator[tuple[str, Memory]]:
    """Start `sparge serve` on a free port; yields its URL and the memory of all its processes."""
    (port,) = free_ports(1)
    url = f"http://127.0.0.1:{port}"
    with tempfile.TemporaryDirectory() as folder:
        process = subprocess.Popen(
            [
                *(sys.executable, "-c", "from services.cli import main; main()"),
                *("serve", "--port", str(port), "--log-level", "warning"),
            ],
            env={**os.environ, "SPARGE_REASONING_KNOWLEDGE_DIR": folder},
        )
        try:
            wait_until_ready(url, process)
            yield url, lambda: tree_mb(process.pid)
        finally:
            process.send_signal(signal.SIGTERM)
            process.wait(timeout=15)


def wait_until_ready(url: str, process: subprocess.Popen[bytes] | None = None) -> None:
    """Return when the backend can answer; the first start compiles its kernels."""
    until = time.monotonic() + READY_S
    while time.monotonic() < until:
        if process is not None and process.poll() is not None:
            raise RuntimeError(f"the backend ended at once, with status {process.returncode}")
        with contextlib.suppress(httpx.HTTPError):
            if httpx.get(f"{url}/health/ready", timeout=10).status_code == 200:
                return
        time.sleep(0.2)
    raise RuntimeError(f"{url} did not get ready within {READY_S:g} s")


def tree_mb(pid: int) -> float:
    """Return the resident memory of a process and all below it, in MB."""
    held = _resident_mb(pid)
    for thread in Path(f"/proc/{pid}/task").glob("*/children"):
        with contextlib.suppress(OSError):
            held += sum(tree_mb(int(child)) for child in thread.read_text().split())
    return held


def compose_mb(project: str) -> float:
    """Return the memory of all containers of a compose project, in MB, as Docker counts it."""
    names = _output("docker", "compose", "--project-name", project, "ps", "--quiet").split()
    if not names:
        raise RuntimeError(f"no container of the compose project {project!r} runs")
    used = _output("docker", "stats", "--no-stream", "--format", "{{.MemUsage}}", *names)
    return sum(_megabytes(line.split("/")[0].strip()) for line in used.splitlines())


def unknown_mb() -> float:
    """Return NaN: the memory of a backend that is only known by its URL."""
    return float("nan")


def _resident_mb(pid: int) -> float:
    try:
        pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    except OSError:  # it has just ended
        return 0.0
    return pages * os.sysconf("SC_PAGESIZE") / 1e6


def _output(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def _megabytes(text: str) -> float:
    number = text.rstrip("BKMGTikb")
    unit = text[len(number) :].lower().removesuffix("b")
    scale = {"": 1e-6, "k": 1e-3, "ki": 2**10 / 1e6, "m": 1.0, "mi": 2**20 / 1e6}
    return float(number) * {**scale, "g": 1e3, "gi": 2**30 / 1e6}[unit]
