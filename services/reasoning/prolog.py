"""SWI-Prolog inside this process, and the one thread that may touch it.

There is one Prolog per process, and pyswip is not safe across threads, so all
work goes through a queue to one thread. Requests and answers cross as JSON
text; no text from outside ever becomes part of a Prolog goal.
"""

from __future__ import annotations

import atexit
import math
import sys
import threading
from concurrent.futures import Future, ThreadPoolExecutor
from ctypes import byref, c_char_p
from pathlib import Path
from typing import Any

import orjson

from shared.deadline import check_deadline, remaining_s
from shared.errors import DeadlineExceeded, InternalError, JsonObject, StageUnavailable

_lock = threading.Lock()
_running: Prolog | None = None


def prolog(rules_dir: Path) -> Prolog:
    """Return the process's Prolog with `rules_dir/service.pl` loaded; start it if needed.

    Raises
    ------
    StageUnavailable
        SWI-Prolog is not installed.
    InternalError
        The Prolog files do not load cleanly, or others are loaded already.
    """
    global _running
    rules_dir = rules_dir.resolve()
    with _lock:
        if _running is None:
            _running = Prolog(rules_dir)
        if _running.rules_dir != rules_dir:
            raise InternalError(
                f"this process reasons with the rules of {_running.rules_dir}; "
                f"it cannot load {rules_dir} as well"
            )
        return _running


class Prolog:
    """The owner thread and its queue. Use `prolog` to get it."""

    def __init__(self, rules_dir: Path) -> None:
        self.rules_dir = rules_dir
        self._owner = ThreadPoolExecutor(max_workers=1, thread_name_prefix="prolog")
        try:
            self._owner.submit(self._start).result()
        except BaseException:
            self._owner.shutdown()
            raise

    def ask(self, operation: str, timeout_s: float | None = None, **arguments: Any) -> JsonObject:
        """Return what service.pl answers.

        Parameters
        ----------
        operation : str
            One of those in service.pl.
        timeout_s : float, optional
            How long to wait, where the request being answered allows as much. Prolog's own
            limit on inferences ends the work itself.
        **arguments
            JSON-compatible.

        Raises
        ------
        DeadlineExceeded
            No answer in time, or too many inferences.
        InternalError
            Rules that do not load, or that raise an error.
        """
        check_deadline()
        left_s = min(math.inf if timeout_s is None else timeout_s, remaining_s())
        text = orjson.dumps({"operation": operation, **arguments})
        job: Future[bytes] = self._owner.submit(self._call, "service", "answer", text)
        try:
            reply = orjson.loads(job.result(left_s if math.isfinite(left_s) else None))
        except TimeoutError:
            job.cancel()
            raise DeadlineExceeded(f"Prolog did not answer within {left_s:.3g} s") from None
        if reply["status"] == "ok":
            result: JsonObject = reply["result"]
            return result
        message = "; ".join(reply["messages"])
        if reply["kind"] == "too_long":
            raise DeadlineExceeded(f"the rules came to no end: {message}")
        raise InternalError(f"Prolog could not {operation}: {message}", kind=reply["kind"])

    def _start(self) -> None:
        leave = sys.exit
        try:
            from pyswip import core
        except Exception as error:
            raise StageUnavailable(
                "SWI-Prolog cannot be loaded; on Debian install it with "
                f"`apt-get install swi-prolog-nox` ({type(error).__name__}: {error})",
                stage="reasoning",
            ) from error
        # pyswip replaces sys.exit, which then only takes numbers, and stops Prolog at
        # exit from a thread that does not own it. The process ends; nothing to stop.
        sys.exit = leave
        atexit.unregister(core.cleanupProlog)
        self._core = core
        self._call("system", "consult", str(self.rules_dir / "loader.pl").encode(), answers=False)
        complaints = self._call("loader", "loaded", str(self.rules_dir / "service.pl").encode())
        if complaints:
            raise InternalError(f"the rules do not load: {complaints.decode()}")

    def _call(self, module: str, predicate: str, text: bytes, *, answers: bool = True) -> bytes:
        """Call module:predicate(Text, Answer) once, or without Answer; in the owner thread."""
        core = self._core
        arity = 2 if answers else 1
        frame = core.PL_open_foreign_frame()
        try:
            terms = core.PL_new_term_refs(arity)
            core.PL_put_chars(terms, core.PL_STRING | core.REP_UTF8, len(text), text)
            query = core.PL_open_query(
                None,
                core.PL_Q_NODEBUG | core.PL_Q_CATCH_EXCEPTION,
                core.PL_predicate(predicate, arity, module),
                terms,
            )
            try:
                holds = core.PL_next_solution(query)
                error = core.PL_exception(query)
                if error:
                    raise InternalError(f"Prolog: {self._text(error, core.CVT_WRITE).decode()}")
                if not holds:
                    raise InternalError(f"Prolog: {module}:{predicate}/{arity} failed")
                return self._text(terms + 1, core.CVT_ATOMIC) if answers else b""
            finally:
                core.PL_cut_query(query)
        finally:
            core.PL_discard_foreign_frame(frame)

    def _text(self, term: int, kinds: int) -> bytes:
        """Return a term's text as UTF-8; `kinds` says which terms to convert and how."""
        core = self._core
        chars = c_char_p()
        with core.PL_STRINGS_MARK():
            if not core.PL_get_chars(term, byref(chars), kinds | core.BUF_STACK | core.REP_UTF8):
                raise InternalError("Prolog gave no text")
            return bytes(chars.value or b"")
