"""A stage behind a socket that can be made to fail.

It takes one request per connection and answers what the true stage answers; `fault`, a
function, may do anything else with the connection instead.
"""

from __future__ import annotations

import contextlib
import socket
import struct
import threading
import time
from collections.abc import Callable, Iterator, Mapping

import httpx

from tests.support.serving import Client

Fault = Callable[["Exchange"], None]
PATIENCE_S = 60.0
_HOP_BY_HOP = {"connection", "content-length", "transfer-encoding", "content-encoding"}


class Exchange:
    """One request and the connection that waits for its answer.

    Parameters
    ----------
    connection : socket.socket
    request : tuple
        Method, path, headers and body.
    stage : Client
        The true stage.
    over : threading.Event
        Set when the server stops.
    """

    def __init__(
        self,
        connection: socket.socket,
        request: tuple[str, str, dict[str, str], bytes],
        stage: Client,
        over: threading.Event,
    ) -> None:
        self._connection = connection
        self._request = request
        self._stage = stage
        self._over = over

    def true_answer(self) -> httpx.Response:
        """Return what the stage answers."""
        method, path, headers, body = self._request
        return self._stage.request(method, path, headers=headers, content=body or None)

    def send(self, data: bytes) -> None:
        """Send bytes as they are; nobody may be there any more."""
        with contextlib.suppress(OSError):
            self._connection.sendall(data)

    def answer(
        self,
        body: bytes,
        headers: Mapping[str, str] | None = None,
        *,
        status: int = 200,
        length: int | None = None,
    ) -> None:
        """Send an HTTP answer, with a true length or another one."""
        lines = [f"HTTP/1.1 {status} x", "connection: close"]
        lines += [f"{name}: {value}" for name, value in (headers or {}).items()]
        lines.append(f"content-length: {len(body) if length is None else length}")
        self.send("\r\n".join([*lines, "", ""]).encode() + body)

    def pass_on(self) -> None:
        """Send the true answer."""
        answer = self.true_answer()
        headers = {k: v for k, v in answer.headers.items() if k not in _HOP_BY_HOP}
        self.answer(answer.content, headers, status=answer.status_code)

    def wait(self, seconds: float = PATIENCE_S) -> bool:
        """Wait; False when the server stops or the other side is gone."""
        until = time.monotonic() + seconds
        self._connection.settimeout(0.02)
        while time.monotonic() < until and not self._over.is_set():
            try:
                if not self._connection.recv(1024):
                    return False
            except TimeoutError:
                continue
            except OSError:
                return False
        return not self._over.is_set()

    def reset(self) -> None:
        """End the connection as a process that crashes does."""
        self._connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self._connection.close()


class FaultyStage:
    """Serves one stage on a port of the loopback.

    Parameters
    ----------
    stage : Client
        The true stage.

    Attributes
    ----------
    fault : callable or None
        What is done with a request; None: it gets the true answer.
    fails_health : bool
        The fault is for `/health/ready` as well.
    """

    def __init__(self, stage: Client) -> None:
        self.fault: Fault | None = None
        self.fails_health = False
        self._stage = stage
        self._listener = socket.create_server(("127.0.0.1", 0), backlog=256)
        self._over = threading.Event()
        threading.Thread(target=self._accept, daemon=True).start()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self._listener.getsockname()[1]}"

    @contextlib.contextmanager
    def failing(self, fault: Fault, *, health: bool = False) -> Iterator[None]:
        """Fail like this for a while; `health`: there, too."""
        self.fault, self.fails_health = fault, health
        try:
            yield
        finally:
            self.fault, self.fails_health = None, False

    def stop(self) -> None:
        """Let go of the port and of every connection."""
        self._over.set()
        with contextlib.suppress(OSError):
            self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()

    def _accept(self) -> None:
        while True:
            try:
                connection, _ = self._listener.accept()
            except OSError:
                return
            threading.Thread(target=self._serve, args=(connection,), daemon=True).start()

    def _serve(self, connection: socket.socket) -> None:
        with connection, contextlib.suppress(OSError):
            request = _read_request(connection)
            if request is None:
                return
            exchange = Exchange(connection, request, self._stage, self._over)
            spared = request[1].startswith("/health") and not self.fails_health
            if self.fault is None or spared:
                exchange.pass_on()
            else:
                self.fault(exchange)


def _read_request(connection: socket.socket) -> tuple[str, str, dict[str, str], bytes] | None:
    held = b""
    while b"\r\n\r\n" not in held:
        piece = connection.recv(1 << 16)
        if not piece:
            return None
        held += piece
    head, _, body = held.partition(b"\r\n\r\n")
    first, *lines = head.decode("latin-1").split("\r\n")
    method, path, _ = first.split(" ")
    headers = {name.lower(): value.strip() for name, _, value in (x.partition(":") for x in lines)}
    length = int(headers.pop("content-length", "0"))
    pieces = [body]
    left = length - len(body)
    while left > 0 and (piece := connection.recv(1 << 16)):
        pieces.append(piece)
        left -= len(piece)
    kept = ("accept", "content-type", "x-request-id")
    return method, path, {k: headers[k] for k in kept if k in headers}, b"".join(pieces)
