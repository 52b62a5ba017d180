"""A child process that does what it is told: `python -m tests.support.odd_child FD [boast]`."""

from __future__ import annotations

import os
import signal
import socket
import struct
import sys
import time

from shared.child import serve
from shared.errors import UnknownGripper


def respond(what: bytes) -> list[bytes]:
    """Echo, or fail in the way that is asked for."""
    if what == b"refuse":
        raise UnknownGripper("unknown gripper 'soft'", found="soft")
    if what == b"fault":
        raise ZeroDivisionError("a fault of ours")
    if what == b"crash":
        os.kill(os.getpid(), signal.SIGSEGV)
    if what == b"hang":
        time.sleep(60)
    return [what, b"", what]


def boast(descriptor: int) -> None:
    """Announce an answer larger than any memory."""
    with socket.socket(fileno=descriptor) as pipe:
        for frame in (b"ready", b"answer", b"1"):
            pipe.sendall(struct.pack("<Q", len(frame)) + frame)
        pipe.sendall(struct.pack("<Q", 2**62))
        while pipe.recv(100):
            pass


if __name__ == "__main__":
    if "boast" in sys.argv:
        boast(int(sys.argv[1]))
    else:
        serve(int(sys.argv[1]), respond, frames=1)
