"""Checks that load native code run in a process of their own: a crash is a finding."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator

import orjson

from services.cli.doctor.finding import Finding, Status
from shared.settings import PROJECT_ROOT

_KEPT_LINES = 3


def probe(name: str, *arguments: str, timeout_s: float = 120.0) -> Iterator[Finding]:
    """Run a probe of `services.cli.doctor.probes` and return its findings, and how it ended.

    Parameters
    ----------
    name : str
        Of the function there.
    timeout_s : float
        It is ended after that.
    """
    path = os.pathsep.join([str(PROJECT_ROOT), *(each for each in sys.path if each)])
    try:
        done = subprocess.run(
            [sys.executable, "-m", "services.cli.doctor.probes", name, *arguments],
            env={**os.environ, "PYTHONPATH": path},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=timeout_s,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        yield from _findings(error.stdout or b"", f"took longer than {timeout_s:g} s", b"")
        return
    ended = "" if done.returncode == 0 else _how_it_ended(done.returncode)
    yield from _findings(done.stdout, ended, done.stderr)


def _findings(output: bytes, ended: str, errors: bytes) -> Iterator[Finding]:
    """Return the findings in a probe's output; what was begun and has none is what failed."""
    begun = ""
    for line in output.splitlines():
        said = orjson.loads(line)
        if "begun" in said:
            begun = said["begun"]
        else:
            yield Finding(**{**said, "status": Status(said["status"])})
    if ended:
        tail = " / ".join(errors.decode(errors="replace").strip().splitlines()[-_KEPT_LINES:])
        message = f"the process that checked it {ended}" + (f": {tail}" if tail else "")
        yield Finding(begun or "doctor", Status.fail, message, "reinstall what it was loading")


def _how_it_ended(code: int) -> str:
    if code > 0:
        return f"ended with status {code}"
    try:
        return f"was ended by {signal.Signals(-code).name}"
    except ValueError:
        return f"was ended by signal {-code}"
