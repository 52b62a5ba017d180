"""What a process and its children have used so far, by the kernel's count; Linux."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

_PROC = Path("/proc")
_TICKS_PER_SECOND = os.sysconf("SC_CLK_TCK")


@dataclass(frozen=True)
class Usage:
    """Of a process and all that it started and that still runs.

    Attributes
    ----------
    cpu_s : float
        Processor time, that of children that have ended included.
    peak_mb : float
        The most memory that each has held, added up; 10^6 bytes.
    """

    cpu_s: float
    peak_mb: float


def usage(pid: int) -> Usage:
    """Return what the process `pid` has used.

    Raises
    ------
    ProcessLookupError
        It does not run.
    """
    pids = list(_family(pid))
    return Usage(sum(map(_cpu_s, pids)), sum(map(_peak_mb, pids)))


def _family(pid: int) -> Iterator[int]:
    yield pid
    for children in _PROC.glob(f"{pid}/task/*/children"):
        for child in children.read_text().split():
            yield from _family(int(child))


def _cpu_s(pid: int) -> float:
    fields = _read(pid, "stat").rpartition(")")[2].split()  # the name before may hold blanks
    return sum(map(int, fields[11:15])) / _TICKS_PER_SECOND  # utime stime cutime cstime


def _peak_mb(pid: int) -> float:
    for line in _read(pid, "status").splitlines():
        if line.startswith("VmHWM:"):
            return int(line.split()[1]) * 1024 / 1e6
    return 0.0  # a process that has ended and is not yet waited for


def _read(pid: int, name: str) -> str:
    try:
        return (_PROC / str(pid) / name).read_text()
    except FileNotFoundError:
        raise ProcessLookupError(f"there is no process {pid}") from None
