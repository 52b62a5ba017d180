"""The other end of the pipe: a simulation process that is started, asked, and replaced."""

from __future__ import annotations

import logging
import os
import subprocess
import sys
from math import ceil
from multiprocessing import Pipe

import orjson

from services.execution.process import ANSWER, READY
from shared.errors import DeadlineExceeded, InternalError, StageUnavailable, error_from_envelope
from shared.schemas.execution import ExecuteRequest, ExecuteResponse
from shared.schemas.gripper import ParallelGripper, SuctionGripper
from shared.wire import NPZ, decode, encode

START_LIMIT_S = 60.0

log = logging.getLogger("sparge.execution")


class Simulator:
    """One simulation process; not for use by two threads at once.

    Native code can crash or hang, and PyBullet's clients share state within a
    process, so simulations live in a process of their own. It is started with
    `-m`, not forked: it inherits no lock of a running service and never runs
    the caller's main module again.
    """

    def __init__(self) -> None:
        self._pipe, theirs = Pipe()
        with theirs:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "services.execution.process", str(theirs.fileno())],
                pass_fds=[theirs.fileno()],
                stdin=subprocess.DEVNULL,
                env={
                    **os.environ,
                    "PYTHONPATH": os.pathsep.join(path for path in sys.path if path),
                    "OMP_NUM_THREADS": "1",  # the matrices are 6 x 7
                    "OPENBLAS_NUM_THREADS": "1",
                },
            )
        self.executions = 0
        try:
            started = self._pipe.poll(START_LIMIT_S) and self._pipe.recv_bytes() == READY
        except (EOFError, OSError):
            started = False
        if not started:
            self.stop()
            raise StageUnavailable(
                f"the simulation process did not start (exit status {self._process.returncode})",
                stage="execution",
            )

    @property
    def alive(self) -> bool:
        return self._process.poll() is None

    def run(
        self,
        request: ExecuteRequest,
        gripper: ParallelGripper | SuctionGripper,
        limit_s: float,
    ) -> ExecuteResponse:
        """Return the answer of the simulation.

        Raises
        ------
        SpargeError
            What the simulation found wrong with the request.
        DeadlineExceeded
            It took longer than `limit_s`; the process is ended.
        StageUnavailable
            The process died.
        """
        self.executions += 1
        try:
            self._pipe.send_bytes(str(ceil(limit_s)).encode())
            self._pipe.send_bytes(gripper.model_dump_json().encode())
            self._pipe.send_bytes(encode(request, NPZ))
            if not self._pipe.poll(limit_s):
                self.stop()
                raise DeadlineExceeded(
                    f"the simulation took longer than {limit_s:g} s", stage="execution"
                )
            answer = self._pipe.recv_bytes()
        except (EOFError, OSError):
            self.stop()
            raise StageUnavailable(
                f"the simulation process died (exit status {self._process.returncode})",
                stage="execution",
            ) from None
        return read_answer(answer)

    def stop(self) -> None:
        """End the process, whatever it is doing."""
        self._pipe.close()
        self._process.kill()
        self._process.wait()


def read_answer(answer: bytes) -> ExecuteResponse:
    """Return what the process answered, or raise the error that it is.

    The traceback of a fault goes to the log, where the request's id is known.
    """
    if answer.startswith(ANSWER):
        return decode(ExecuteResponse, answer[1:], NPZ, max_unpacked_bytes=sys.maxsize)
    failure = orjson.loads(answer[1:])
    if failure["traceback"]:
        log.error("the simulation failed: %s", failure["traceback"])
    raise error_from_envelope(failure["status"], failure) or InternalError("no envelope")
