"""What the execution service can be told, from `SPARGE_EXECUTION_*`."""

from __future__ import annotations

from pydantic import Field

from shared.grippers import GripperSettings
from shared.settings import environment


class ExecutionSettings(GripperSettings):
    """Limits of the simulation; its physics is fixed in the domain modules.

    Attributes
    ----------
    workers : int
        Simulation processes; each runs one execution at a time.
    time_limit_s : float
        Wall time that one execution may take before its process is ended.
    film_time_s : float
        How much longer it may take when it is filmed.
    queue_wait_s : float
        Executions take seconds, so more waiting for a free process is worth while.
    executions_per_worker : int
        A process is replaced after this many, whatever native code has leaked.
    """

    model_config = environment("execution")

    workers: int = Field(default=2, ge=1, le=64)
    time_limit_s: float = Field(default=30.0, gt=0)
    film_time_s: float = Field(default=25.0, ge=0)
    queue_wait_s: float = Field(default=20.0, ge=0)
    executions_per_worker: int = Field(default=500, ge=1)

    @property
    def concurrency(self) -> int:
        """How many executions run at once: one in every process."""
        return self.workers
