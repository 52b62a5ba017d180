"""The simulation process: reads requests from a pipe, answers each, ends with the pipe.

Run as `python -m services.execution.process FD`. Frames are bodies of the
project's own messages, so nothing is pickled. Bullet and V-HACD print to the
standard output from C; this process discards it.
"""

from __future__ import annotations

import os
import signal
import sys
import traceback
from multiprocessing.connection import Connection

import orjson
from pydantic import TypeAdapter

from shared.errors import InternalError, SpargeError
from shared.schemas.execution import ExecuteRequest
from shared.schemas.gripper import Gripper, ParallelGripper, SuctionGripper
from shared.wire import NPZ, decode, encode

READY = b"ready"
ANSWER, FAILURE = b"A", b"F"
GRACE_S = 2
"""The alarm that ends a stuck simulation rings this much after the parent's own limit."""

GRIPPER: TypeAdapter[ParallelGripper | SuctionGripper] = TypeAdapter(Gripper)


def main() -> None:
    """Serve the pipe whose descriptor is the first argument, until it closes."""
    pipe = Connection(int(sys.argv[1]))
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the parent's to handle
    _discard(1)
    errors = os.dup(2)
    _discard(2)  # PyBullet says when it was built, each time it is imported
    from services.execution.protocol import warm_up

    os.dup2(errors, 2)
    warm_up()
    try:
        pipe.send_bytes(READY)
        while True:
            limit_s = int(pipe.recv_bytes())
            gripper = pipe.recv_bytes()
            request = pipe.recv_bytes()
            signal.alarm(limit_s + GRACE_S)  # default action: end the process, even inside C
            answer = respond(gripper, request)
            signal.alarm(0)
            pipe.send_bytes(answer)
    except (EOFError, BrokenPipeError, ConnectionResetError):
        return


def respond(gripper: bytes, request: bytes) -> bytes:
    """Return the marked answer, or the marked error envelope; gripper in JSON, request in npz.

    The traceback of a fault of ours goes along: the parent has the log and the request's id.
    """
    from services.execution.protocol import execute

    try:
        message = decode(ExecuteRequest, request, NPZ, max_unpacked_bytes=sys.maxsize)
        return ANSWER + encode(execute(message, GRIPPER.validate_json(gripper)), NPZ)
    except SpargeError as error:
        return FAILURE + _envelope(error)
    except Exception:
        failure = InternalError("the simulation failed; the log of the service says why")
        return FAILURE + _envelope(failure, traceback.format_exc())


def _discard(descriptor: int) -> None:
    """Send what is written to `descriptor` nowhere, from C as well."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, descriptor)
    os.close(nowhere)


def _envelope(error: SpargeError, trace: str | None = None) -> bytes:
    return orjson.dumps({"status": error.status, "traceback": trace, **error.envelope("")})


if __name__ == "__main__":
    main()
