"""Work of which only the newest matters."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from functools import partial

log = logging.getLogger("sparge")

SETTLE_S = 0.06

Work = Callable[[Callable[[], bool]], None]
"""Told by what it is given whether it is still the newest; it shows nothing if not."""


class Newest:
    """Runs the newest work in a thread of its own; what waits when newer comes is dropped.

    A slider that is dragged asks for much more than can be answered. Work waits for a moment, so
    that what comes at once is done once.
    """

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._waiting: Work | None = None
        self._number = 0
        self._is_open = True
        self._thread = threading.Thread(target=self._run, name="viewer", daemon=True)
        self._thread.start()

    def submit(self, work: Work) -> None:
        """Do `work` as soon as what is being done is done, unless newer comes before."""
        with self._changed:
            self._number += 1
            self._waiting = work
            self._changed.notify()

    def close(self) -> None:
        """Do nothing more."""
        with self._changed:
            self._is_open = False
            self._number += 1
            self._waiting = None
            self._changed.notify()

    def _run(self) -> None:
        while True:
            with self._changed:
                while self._waiting is None and self._is_open:
                    self._changed.wait()
                self._changed.wait_for(lambda: not self._is_open, SETTLE_S)
                if not self._is_open or self._waiting is None:
                    return
                work, self._waiting, number = self._waiting, None, self._number
            try:
                work(partial(self._is_newest, number))
            except Exception:
                log.exception("the viewer failed at a piece of work")

    def _is_newest(self, number: int) -> bool:
        return number == self._number
