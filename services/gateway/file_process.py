"""The process that reads uploaded files, within bounds of memory and time.

Run as `python -m services.gateway.file_process FD MEMORY TIME`: what it may take beside the
memory that it starts with, in bytes, and of the processor for one file, in seconds. What it
decodes with native code (PNG, the compression inside PCD) or line by line is the work of
strangers; should it crash a library, take all memory or come to no end, this process goes
and not the gateway.
"""

from __future__ import annotations

import contextlib
import functools
import resource
import signal
import sys
from pathlib import Path

import orjson

from shared.child import serve
from shared.errors import UnreadableFile
from shared.wire.files import read_cloud_file
from shared.wire.npz import write_npy

FIRST_OF_ALL = "1000"
"""On the kernel's scale of what to end when memory runs out: this process before any other."""


def main() -> None:
    """Serve the pipe whose descriptor is the first argument, until it closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the parent's to handle
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with contextlib.suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text(FIRST_OF_ALL)
    memory_bytes, time_s = int(sys.argv[2]), float(sys.argv[3])
    _limit_memory(memory_bytes)
    respond = functools.partial(_respond, memory_bytes, time_s)
    serve(int(sys.argv[1]), respond, frames=2)


def _respond(
    memory_bytes: int, time_s: float, question: bytes, data: bytes
) -> tuple[bytes, memoryview]:
    """Return what a file holds: everything but its large array as JSON, that array as npy.

    Parameters
    ----------
    memory_bytes : int
        The bound, for the message.
    time_s : float
        When it is over, the process ends by SIGPROF.
    question : bytes
        The arguments of `read_cloud_file` but for the data, as JSON.
    data : bytes
        The file.

    Raises
    ------
    SpargeError
        As `read_cloud_file`.
    UnreadableFile
        The memory is not enough.
    """
    signal.setitimer(signal.ITIMER_PROF, time_s)  # default action: end the process, even inside C
    try:
        held = read_cloud_file(data=data, **orjson.loads(question)).fields()
        name = "points" if "points" in held else "depth"
        array = write_npy(held.pop(name))
        return orjson.dumps({"array": name, **held}, option=orjson.OPT_SERIALIZE_NUMPY), array
    except MemoryError:
        raise UnreadableFile(
            f"reading the file takes more than {memory_bytes} bytes of memory",
            field="file",
            allowed=memory_bytes,
        ) from None
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def _limit_memory(more: int) -> None:
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    bound = pages * resource.getpagesize() + more
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    if hard != resource.RLIM_INFINITY:
        bound = min(bound, hard)
    resource.setrlimit(resource.RLIMIT_AS, (bound, hard))


if __name__ == "__main__":
    main()
