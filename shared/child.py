"""A process beside this one, for work that may crash, hang or take all memory.

It is started with `-m`, not forked: it inherits no lock of a running service and never runs
the caller's main module again. The two send each other frames of bytes over a pair of
sockets; nothing is pickled, and what comes back is no more to be trusted than what went in.
"""

from __future__ import annotations

import contextlib
import json
import logging
import os
import socket
import struct
import subprocess
import sys
import threading
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence

from shared.errors import InternalError, SpargeError, error_from_envelope

START_LIMIT_S = 60.0
_READY, _ANSWER, _FAILURE = b"ready", b"answer", b"failure"
Frame = bytes | memoryview
_LENGTH = struct.Struct("<Q")
_BUFFER_BYTES = 2**20
_FEW = 16
_LAST_WORDS_S = 5.0

log = logging.getLogger("sparge")


class ChildEnded(Exception):
    """The process ended before it answered.

    Attributes
    ----------
    exit_status : int
        Minus the number of the signal that ended it, as in `subprocess`.
    """

    def __init__(self, exit_status: int) -> None:
        super().__init__(f"exit status {exit_status}")
        self.exit_status = exit_status


class ChildTooSlow(Exception):
    """The answer was not there in time; the process was ended."""


class Child:
    """One process; not for use by two threads at once.

    Parameters
    ----------
    module : str
        Run as `python -m MODULE FD ARGUMENTS`; calls `serve` with that descriptor.
    *arguments : str
        Further ones for it.
    environment : mapping
        Its environment variables; where Python looks for modules is added.

    Raises
    ------
    ChildEnded
        It does not start.
    """

    def __init__(self, module: str, *arguments: str, environment: Mapping[str, str]) -> None:
        self._pipe, theirs = socket.socketpair()
        for end in (self._pipe, theirs):
            end.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _BUFFER_BYTES)
        with theirs, _closed_on_error(self._pipe):
            self._process = subprocess.Popen(
                [sys.executable, "-m", module, str(theirs.fileno()), *arguments],
                pass_fds=[theirs.fileno()],
                stdin=subprocess.DEVNULL,
                env={**environment, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
            )
        self._pipe.settimeout(START_LIMIT_S)
        try:
            started = _receive(self._pipe) == _READY
        except OSError:
            started = False
        if not started:
            raise ChildEnded(self._end())
        self._pipe.settimeout(None)

    @property
    def alive(self) -> bool:
        return self._process.poll() is None

    def ask(
        self, *frames: bytes, limit_s: float, max_answer_bytes: int = sys.maxsize
    ) -> list[bytes]:
        """Return the frames of the answer to a request.

        Parameters
        ----------
        *frames : bytes
            As many as the process expects.
        limit_s : float
            The process is ended when it takes longer.
        max_answer_bytes : int
            It is ended as well when a frame of its answer is larger.

        Raises
        ------
        SpargeError
            What the process raised.
        ChildTooSlow
            No answer within `limit_s` seconds.
        ChildEnded
            It died, or answered nonsense.
        """
        late = threading.Event()

        def end() -> None:
            late.set()
            self._process.kill()

        watch = threading.Timer(limit_s, end)  # sending can block as well
        watch.start()
        try:
            for frame in frames:
                _send(self._pipe, frame)
            kind, count = _receive(self._pipe, _FEW), _receive(self._pipe, _FEW)
            answer = [_receive(self._pipe, max_answer_bytes) for _ in range(int(count[:2]))]
        except OSError:
            exit_status = self._end()
            raise ChildTooSlow if late.is_set() else ChildEnded(exit_status) from None
        except ValueError:  # nonsense
            self.stop()
            raise ChildEnded(self._process.returncode) from None
        finally:
            watch.cancel()
        if kind != _ANSWER:
            raise _failure(b"".join(answer))
        return answer

    def stop(self) -> None:
        """End the process, whatever it is doing."""
        self._pipe.close()
        self._process.kill()
        self._process.wait()

    def _end(self) -> int:
        """Return the exit status of a process that let go of the pipe."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(_LAST_WORDS_S)
        self.stop()
        return self._process.returncode


def serve(descriptor: int, respond: Callable[..., Sequence[Frame]], frames: int) -> None:
    """Answer in the child until the other side closes the pipe.

    Parameters
    ----------
    descriptor : int
        Of the pipe: the first argument of the child.
    respond : callable
        Takes the frames of a request and returns those of the answer. A `SpargeError` goes to the
        other side; anything else becomes an `InternalError` there, and is logged there.
    frames : int
        How many a request has.
    """
    with socket.socket(fileno=descriptor) as pipe:
        try:
            _send(pipe, _READY)
            while True:
                kind, answer = _answer(respond, [_receive(pipe) for _ in range(frames)])
                for frame in (kind, str(len(answer)).encode(), *answer):
                    _send(pipe, frame)
                del answer, frame  # they may be large
        except ConnectionError:
            return


@contextlib.contextmanager
def _closed_on_error(pipe: socket.socket) -> Iterator[None]:
    try:
        yield
    except BaseException:
        pipe.close()
        raise


def _send(pipe: socket.socket, frame: Frame) -> None:
    pipe.sendall(_LENGTH.pack(len(frame)))
    pipe.sendall(frame)


def _receive(pipe: socket.socket, most: int = sys.maxsize) -> bytes:
    (length,) = _LENGTH.unpack(_receive_exactly(pipe, _LENGTH.size))
    if length > most:
        raise ValueError(f"a frame of {length} bytes, allowed are {most}")
    return bytes(_receive_exactly(pipe, length))


def _receive_exactly(pipe: socket.socket, length: int) -> bytearray:
    held = bytearray(length)
    left = memoryview(held)
    while left:
        count = pipe.recv_into(left)
        if count == 0:
            raise ConnectionResetError("the other side closed the pipe")
        left = left[count:]
    return held


def _answer(
    respond: Callable[..., Sequence[Frame]], frames: list[bytes]
) -> tuple[bytes, Sequence[Frame]]:
    try:
        return _ANSWER, respond(*frames)
    except SpargeError as error:
        failure, trace = error, None
    except Exception:
        failure = InternalError("an internal error; the log of the service says why")
        trace = traceback.format_exc()  # the other side has the log and the request's id
    held = {"status": failure.status, "traceback": trace, **failure.envelope("")}
    return _FAILURE, [json.dumps(held).encode()]  # orjson refuses numbers of over 64 bits


def _failure(answer: bytes) -> SpargeError:
    try:
        held = json.loads(answer)
        if held["traceback"]:
            log.error("a child process failed: %s", held["traceback"])
        return error_from_envelope(held["status"], held) or InternalError("no envelope")
    except (ValueError, TypeError, KeyError):
        return InternalError("a child process answered nonsense")
