"""The stage: checks a request and has a free simulation process replay it."""

from __future__ import annotations

import contextlib
import queue
import threading

from services.execution.checks import check_request
from services.execution.settings import ExecutionSettings
from services.execution.simulator import Simulator
from shared.deadline import remaining_s
from shared.errors import StageUnavailable
from shared.grippers import load_grippers
from shared.schemas.execution import ExecuteRequest, ExecuteResponse


class Executor:
    """A few simulation processes, each used by one request at a time.

    Who asks while all are at work waits; the service lets no more in at once than there are.

    Parameters
    ----------
    settings : ExecutionSettings
    """

    def __init__(self, settings: ExecutionSettings) -> None:
        self._settings = settings
        self._grippers = load_grippers(settings.grippers_dir)
        self._idle: queue.LifoQueue[Simulator | None] = queue.LifoQueue()
        for _ in range(settings.workers):
            self._idle.put(None)  # a place whose process is not started yet
        self._closed = threading.Event()

    def warm_up(self) -> None:
        """Start one process; the others start when they are first needed."""
        self._idle.put(self._ready(self._idle.get()))

    def execute(self, request: ExecuteRequest) -> ExecuteResponse:
        """Replay a grasp with arm or hand and say whether it lifted the object.

        The same request always gets the same answer; `request.seed` changes
        nothing, for nothing here is random.

        Raises
        ------
        InvalidInput
            The request makes no sense; also as `UnknownGripper`, `WrongUnits`,
            `DegenerateCloud`.
        PayloadTooLarge
            The mesh has too many faces.
        DeadlineExceeded, StageUnavailable
            The simulation took too long, or its process died.
        """
        gripper = check_request(request, self._grippers)
        simulator = self._idle.get()
        try:
            simulator = self._ready(simulator)
            return simulator.run(request, gripper, self._limit_s(request))
        finally:
            self._give_back(simulator)

    def close(self) -> None:
        """End the processes; one that is at work ends when its request does."""
        self._closed.set()
        for place in self._taken():
            self._give_back(place)

    def _taken(self) -> list[Simulator | None]:
        """Take all places that nobody is using."""
        taken = []
        with contextlib.suppress(queue.Empty):
            while True:
                taken.append(self._idle.get_nowait())
        return taken

    def _limit_s(self, request: ExecuteRequest) -> float:
        film = self._settings.film_time_s if request.animate else 0.0
        return min(self._settings.time_limit_s + film, max(remaining_s(), 0.0))

    def _ready(self, simulator: Simulator | None) -> Simulator:
        if self._closed.is_set():
            raise StageUnavailable("the execution stage is shutting down", stage="execution")
        if simulator is not None:
            if simulator.alive and simulator.executions < self._settings.executions_per_worker:
                return simulator
            simulator.stop()
        return Simulator()

    def _give_back(self, simulator: Simulator | None) -> None:
        if self._closed.is_set() and simulator is not None:
            simulator.stop()
            simulator = None
        self._idle.put(simulator)
