"""The last explanations, kept for a while so that a person can ask afterwards."""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Callable

from shared.errors import NotFound
from shared.schemas.answer import GraspAnswer, KeptExplanation


class Memory:
    """Explanations by request id: the latest `size` of them, each for `seconds`.

    It lives in one process and is used from its event loop alone.

    Parameters
    ----------
    size : int
        With one more the oldest is forgotten; 0 keeps none.
    seconds : float
        How long one is kept.
    clock : callable, optional
        Seconds since some fixed time.
    """

    def __init__(
        self, size: int, seconds: float, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._size, self._seconds, self._clock = size, seconds, clock
        self._kept: OrderedDict[str, tuple[float, KeptExplanation]] = OrderedDict()

    def keep(self, answer: GraspAnswer) -> None:
        """Remember why `answer` is as it is, if it says so; an id used again is overwritten."""
        if answer.explanation is None:
            return
        fields = {name: getattr(answer, name) for name in KeptExplanation.model_fields}
        self._kept.pop(answer.request_id, None)
        self._kept[answer.request_id] = (self._clock(), KeptExplanation(**fields))
        self._forget()

    def recall(self, request_id: str) -> KeptExplanation:
        """Return what is kept about a request.

        Raises
        ------
        NotFound
            Nothing is, or no longer.
        """
        self._forget()
        if request_id not in self._kept:
            raise NotFound(
                f"no explanation is kept for the request {request_id!r}: the last {self._size} "
                f"are, for {self._seconds:g} s, of requests that asked for one",
                request_id=request_id,
            )
        return self._kept[request_id][1]

    def _forget(self) -> None:
        while len(self._kept) > self._size:
            self._kept.popitem(last=False)
        while self._kept:
            kept_at, _ = next(iter(self._kept.values()))
            if self._clock() - kept_at <= self._seconds:
                return
            self._kept.popitem(last=False)
