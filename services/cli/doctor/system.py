"""The machine: Python, shared libraries, memory, disk, clock, port."""

from __future__ import annotations

import ctypes
import shutil
import socket
import sys
import time
from collections.abc import Collection, Iterator
from pathlib import Path

import httpx

from services.cli.doctor.finding import Finding, Status
from shared.settings import PROJECT_ROOT

PYTHON = ((3, 11), (3, 13))
"""From this version, below that one: `requires-python` of pyproject.toml."""

_MEMORY_GB = 1.0
_DISK_GB = 0.5
_GB = 1e9
# What a library is for, and the Debian package that has it.
_NEEDED = {"libgomp.so.1": ("primitive_recovery", "libgomp1")}
_USEFUL = {
    "libGL.so.1": ("datasets and experiments (open3d)", "libgl1"),
    "libEGL.so.1": ("datasets and experiments (open3d)", "libegl1"),
    "libusb-1.0.so.0": ("datasets and experiments (open3d)", "libusb-1.0-0"),
}


def python(version: tuple[int, ...] = sys.version_info[:3]) -> Iterator[Finding]:
    """Check the interpreter's version."""
    first, beyond = (".".join(map(str, each)) for each in PYTHON)
    found = ".".join(map(str, version))
    if PYTHON[0] <= version < PYTHON[1]:
        yield Finding("python", Status.ok, f"{found} at {sys.executable}")
        return
    advice = f"use Python {first} or later, below {beyond}; `make setup` finds one"
    yield Finding("python", Status.fail, f"{found} at {sys.executable}", advice)


def libraries(stages: Collection[str]) -> Iterator[Finding]:
    """Check the system's shared libraries that the stages of this process need."""
    for name, (stage, package) in _NEEDED.items():
        if stage in stages:
            yield _library(name, stage, package, Status.fail)
    for name, (purpose, package) in _USEFUL.items():
        yield _library(name, purpose, package, Status.warn)


def _library(name: str, purpose: str, package: str, otherwise: Status) -> Finding:
    try:
        ctypes.CDLL(name)
    except OSError as error:
        advice = f"on Debian: apt-get install {package}"
        return Finding(name, otherwise, f"needed for {purpose}: {error}", advice)
    return Finding(name, Status.ok, f"for {purpose}")


def memory(meminfo: Path = Path("/proc/meminfo")) -> Iterator[Finding]:
    """Check that a backend fits into the memory that is free."""
    try:
        lines = dict(line.split(":", 1) for line in meminfo.read_text().splitlines())
        available_gb = float(lines["MemAvailable"].split()[0]) * 1024 / _GB
    except (OSError, KeyError, ValueError):
        yield Finding("memory", Status.skip, "this system does not say how much is free")
        return
    message = f"{available_gb:.1f} GB available"
    if available_gb >= _MEMORY_GB:
        yield Finding("memory", Status.ok, message)
    else:
        advice = f"the whole backend in one process wants {_MEMORY_GB:g} GB"
        yield Finding("memory", Status.warn, message, advice)


def disk() -> Iterator[Finding]:
    """Check that there is room for compiled kernels and knowledge."""
    free_gb = shutil.disk_usage(PROJECT_ROOT).free / _GB
    message = f"{free_gb:.1f} GB free at {PROJECT_ROOT}"
    if free_gb >= _DISK_GB:
        yield Finding("disk", Status.ok, message)
    else:
        yield Finding("disk", Status.warn, message, "make room for kernels and knowledge")


def clock(now: float | None = None) -> Iterator[Finding]:
    """Check that it is not earlier than the installation itself; seconds since 1970."""
    now = time.time() if now is None else now
    shown = time.strftime("%Y-%m-%d %H:%M:%S UTC", time.gmtime(now))
    if now >= Path(__file__).stat().st_mtime:
        yield Finding("clock", Status.ok, shown)
    else:
        advice = "set it (NTP): logs, traces and certificates go by it"
        yield Finding("clock", Status.fail, f"{shown} is before this was installed", advice)


def port(host: str, number: int) -> Iterator[Finding]:
    """Check that a backend can listen there, or that one does."""
    where = f"{host}:{number}"
    with socket.socket() as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((host, number))
        except OSError as error:
            who = _who_listens(f"http://{where}")
            if who is not None:
                yield Finding("port", Status.ok, f"{where}: {who} is running there")
                return
            advice = "choose another with `sparge serve --port`, or stop what listens there"
            yield Finding("port", Status.fail, f"{where}: {error.strerror}", advice)
            return
    yield Finding("port", Status.ok, f"{where} is free")


def _who_listens(url: str) -> str | None:
    try:
        answer = httpx.get(f"{url}/version", timeout=2).json()
        return f"the {answer['service']} of SPaRGE {answer['version']}"
    except (httpx.HTTPError, ValueError, KeyError, TypeError):
        return None
