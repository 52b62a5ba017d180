"""When, how and on what an experiment ran."""

from __future__ import annotations

import datetime
import importlib.metadata
import os
import platform
import shlex
import subprocess
import sys
from pathlib import Path

from shared import __version__
from shared.client import Sparge
from shared.schemas.route import Nothing, Route
from shared.wire import Message

PACKAGES = ("numpy", "scipy", "open3d-cpu", "numba", "onnxruntime", "pyswip", "rdflib", "pybullet")


class Build(Message):
    """Which build of the backend answers."""

    service: str
    version: str


VERSION = Route("gateway", "/version", Nothing, Build, "Which build answers", "GET")


def provenance(sparge: Sparge, where: str, seed: int) -> dict[str, str]:
    """Return what has to be known to repeat a run, by name.

    Raises
    ------
    SpargeError
        The backend does not tell its version.
    """
    return {
        "date": datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "command": command(),
        "seed": str(seed),
        "backend": f"{where}, version {sparge.call(VERSION, Nothing()).version}",
        "machine": machine(),
        "versions": versions(),
    }


def command() -> str:
    """Return the command line of this process, the program by its name only."""
    program, *arguments = sys.argv
    return shlex.join([Path(program).name, *arguments])


def machine() -> str:
    """Return processor, cores, memory and system."""
    pages, size = os.sysconf("SC_PHYS_PAGES"), os.sysconf("SC_PAGE_SIZE")
    cores = len(os.sched_getaffinity(0))
    system = f"{platform.system()} {platform.release()}"
    return f"{_processor()}, {cores} cores, {pages * size / 2**30:.0f} GiB, {system}"


def versions() -> str:
    """Return SPaRGE, Python and the libraries that figures depend on."""
    held = [f"SPaRGE {__version__}{_commit()}", f"Python {platform.python_version()}"]
    for package in PACKAGES:
        try:
            held.append(f"{package} {importlib.metadata.version(package)}")
        except importlib.metadata.PackageNotFoundError:
            continue
    return ", ".join(held)


def _commit() -> str:
    """Return ` (commit)` where this is a checkout, with a + for changes since."""
    try:
        described = subprocess.run(
            ["git", "describe", "--always", "--dirty=+", "--abbrev=10"],
            cwd=Path(__file__).parent,
            capture_output=True,
            text=True,
            timeout=10,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return f" ({described.stdout.strip()})"


def _processor() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()
