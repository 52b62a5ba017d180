"""SPARQL over the knowledge, in a process that can be ended."""

from __future__ import annotations

import json
import os
import select
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping

from rdflib import Graph

from shared.errors import (
    DeadlineExceeded,
    InternalError,
    InvalidInput,
    JsonObject,
    StageUnavailable,
    TooBusy,
)
from shared.schemas.knowledge import SparqlAnswer
from shared.settings import PROJECT_ROOT

_START_S = 60.0


class Sparql:
    """Answers queries one at a time, each within a bounded time.

    Parameters
    ----------
    timeout_s : float
        For one query, and for the wait until those before it are done.
    max_rows : int
        The rest of an answer is left out, and the answer says so.
    """

    def __init__(self, timeout_s: float, max_rows: int) -> None:
        self._timeout_s = timeout_s
        self._max_rows = max_rows
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._graph_version: object = None
        self._rest = b""

    def ask(
        self,
        query: str,
        version: object,
        graph: Callable[[], Graph],
        facts: Graph | None = None,
        bindings: Mapping[str, str] | None = None,
    ) -> SparqlAnswer:
        """Return the answer to `query`.

        Parameters
        ----------
        query : str
            SELECT or ASK.
        version : object
            Of the graph; `graph` is only called for another one than last time.
        graph : callable
            Returns what is asked about.
        facts : Graph, optional
            Further statements, for this query alone.
        bindings : mapping, optional
            IRIs for variables of the query.

        Raises
        ------
        InvalidInput
            Not a query, or one that is not answered here.
        DeadlineExceeded
            It takes too long.
        TooBusy
            The queries before it take too long.
        StageUnavailable
            The process cannot be started.
        """
        if not self._lock.acquire(timeout=self._timeout_s):
            raise TooBusy("other SPARQL queries are still being answered; ask again")
        try:
            process = self._running()
            is_new = version != self._graph_version
            text = graph().serialize(format="nt") if is_new else None
            limit = self._timeout_s + (len(text) / 1e6 if text else 0)  # to read a megabyte: 1 s
            asked = {
                "limit_s": limit,
                "graph": text,
                "query": query,
                "facts": (facts or Graph()).serialize(format="nt"),
                "bindings": dict(bindings or {}),
                "max_rows": self._max_rows,
            }
            reply = self._exchange(process, asked, limit)
            self._graph_version = version
        finally:
            self._lock.release()
        if "refused" in reply:
            raise InvalidInput(f"query: {reply['refused']}", field="query")
        return SparqlAnswer.model_validate(reply["answer"])

    def close(self) -> None:
        """End the process."""
        with self._lock:
            self._end()

    def _running(self) -> subprocess.Popen[bytes]:
        if self._process is None or self._process.poll() is not None:
            self._end()
            path = os.pathsep.join(
                each for each in (str(PROJECT_ROOT), os.environ.get("PYTHONPATH")) if each
            )
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-m", "services.reasoning.sparql_worker"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                env={**os.environ, "PYTHONPATH": path},
            )
            if self._line(self._process, _START_S) != b"ready":
                self._end()
                raise StageUnavailable("the process for SPARQL cannot start", stage="reasoning")
        return self._process

    def _exchange(
        self, process: subprocess.Popen[bytes], asked: JsonObject, limit_s: float
    ) -> JsonObject:
        assert process.stdin is not None
        try:
            process.stdin.write(json.dumps(asked).encode() + b"\n")
            process.stdin.flush()
            reply: JsonObject = json.loads(self._line(process, limit_s))
        except DeadlineExceeded:
            self._end()
            raise
        except (OSError, ValueError) as error:
            self._end()
            raise InternalError(f"the process for SPARQL ended: {error}") from error
        return reply

    def _line(self, process: subprocess.Popen[bytes], limit_s: float) -> bytes:
        """Return the next line that the process writes; empty when it has ended."""
        assert process.stdout is not None
        deadline = time.monotonic() + limit_s
        while b"\n" not in self._rest:
            left = deadline - time.monotonic()
            if left <= 0 or not select.select([process.stdout], [], [], left)[0]:
                raise DeadlineExceeded(f"the query took longer than {self._timeout_s:g} s")
            piece = os.read(process.stdout.fileno(), 1 << 16)
            if not piece:
                return b""
            self._rest += piece
        line, _, self._rest = self._rest.partition(b"\n")
        return line

    def _end(self) -> None:
        process, self._process = self._process, None
        self._graph_version, self._rest = None, b""
        if process is not None:
            process.kill()
            process.wait()
            for stream in (process.stdin, process.stdout):
                if stream is not None:
                    stream.close()
