"""The simulation process: reads requests from a pipe, answers each, ends with the pipe.

Run as `python -m services.execution.process FD`. Frames are bodies of the
project's own messages, so nothing is pickled. Bullet and V-HACD print to the
standard output from C; this process discards it.
"""

from __future__ import annotations

import os
import signal
import sys

from pydantic import TypeAdapter

from shared.child import serve
from shared.schemas.execution import ExecuteRequest
from shared.schemas.gripper import Gripper, ParallelGripper, SuctionGripper
from shared.wire import NPZ, decode, encode

GRACE_S = 2
"""The alarm that ends a stuck simulation rings this much after the parent's own limit."""

GRIPPER: TypeAdapter[ParallelGripper | SuctionGripper] = TypeAdapter(Gripper)


def main() -> None:
    """Serve the pipe whose descriptor is the first argument, until it closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the parent's to handle
    _discard(1)
    errors = os.dup(2)
    _discard(2)  # PyBullet says when it was built, each time it is imported
    from services.execution.protocol import warm_up

    os.dup2(errors, 2)
    warm_up()
    serve(int(sys.argv[1]), respond, frames=3)


def respond(limit_s: bytes, gripper: bytes, request: bytes) -> list[bytes]:
    """Return the answer, one frame of npz; gripper in JSON, request in npz, limit in seconds."""
    from services.execution.protocol import execute

    message = decode(ExecuteRequest, request, NPZ, max_unpacked_bytes=sys.maxsize)
    signal.alarm(int(limit_s) + GRACE_S)  # default action: end the process, even inside C
    try:
        return [encode(execute(message, GRIPPER.validate_json(gripper)), NPZ)]
    finally:
        signal.alarm(0)


def _discard(descriptor: int) -> None:
    """Send what is written to `descriptor` nowhere, from C as well."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, descriptor)
    os.close(nowhere)


if __name__ == "__main__":
    main()
