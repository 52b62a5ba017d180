"""The other end of the pipe: a simulation process that is started, asked, and replaced."""

from __future__ import annotations

import os
import sys
from math import ceil

from shared.child import Child, ChildEnded, ChildTooSlow
from shared.errors import DeadlineExceeded, StageUnavailable
from shared.schemas.execution import ExecuteRequest, ExecuteResponse
from shared.schemas.gripper import ParallelGripper, SuctionGripper
from shared.wire import NPZ, decode, encode


class Simulator(Child):
    """One simulation process; not for use by two threads at once.

    Native code can crash or hang, and PyBullet's clients share state within a
    process, so simulations live in a process of their own.
    """

    def __init__(self) -> None:
        one_thread = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}  # matrices are 6 x 7
        environment = {**os.environ, **one_thread}
        try:
            super().__init__("services.execution.process", environment=environment)
        except ChildEnded as end:
            raise StageUnavailable(
                f"the simulation process did not start ({end})", stage="execution"
            ) from None
        self.executions = 0

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
            (answer,) = self.ask(
                str(ceil(limit_s)).encode(),
                gripper.model_dump_json().encode(),
                encode(request, NPZ),
                limit_s=limit_s,
            )
        except ChildTooSlow:
            raise DeadlineExceeded(
                f"the simulation took longer than {limit_s:g} s", stage="execution"
            ) from None
        except ChildEnded as end:
            raise StageUnavailable(
                f"the simulation process died ({end})", stage="execution"
            ) from None
        return decode(ExecuteResponse, answer, NPZ, max_unpacked_bytes=sys.maxsize)
