"""The backend that the tools ask, started beside the server: who connects need not wait."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import AbstractContextManager

from shared.client import Sparge
from shared.errors import SpargeError, StageUnavailable

PATIENCE_S = 45.0
"""Agents give a tool about a minute."""


class Backend:
    """A backend that is entered, and left, in a thread of its own.

    Parameters
    ----------
    start : callable
        Gives the context in which there is a backend.
    patience_s : float
        How long `sparge` waits for it.
    """

    def __init__(
        self, start: Callable[[], AbstractContextManager[Sparge]], patience_s: float = PATIENCE_S
    ) -> None:
        self._start = start
        self._patience_s = patience_s
        self._started: Future[Sparge] = Future()

    @contextlib.contextmanager
    def running(self) -> Iterator[None]:
        """Start it now, and stop it in the end."""
        stopping = threading.Event()

        def run() -> None:
            try:
                with self._start() as sparge:
                    self._started.set_result(sparge)
                    stopping.wait()
            except Exception as error:
                if self._started.done():
                    raise
                self._started.set_exception(error)

        self._started = Future()
        thread = threading.Thread(target=run, name="backend")
        thread.start()
        try:
            yield
        finally:
            stopping.set()
            thread.join()

    @property
    def sparge(self) -> Sparge:
        """The backend, as soon as it is there.

        Raises
        ------
        StageUnavailable
            It is still starting, or cannot.
        """
        try:
            return self._started.result(self._patience_s)
        except TimeoutError:
            raise StageUnavailable(
                "the backend is still starting; the first start on a machine compiles for minutes",
                retry_after_s=30,
            ) from None
        except SpargeError:
            raise
        except Exception as error:
            raise StageUnavailable(f"the backend cannot start: {error}") from error
