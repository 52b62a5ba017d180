"""A child process that does what it is told: `python -m tests.support.odd_child FD`."""

from __future__ import annotations

import os
import signal
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


if __name__ == "__main__":
    serve(int(sys.argv[1]), respond, frames=1)
