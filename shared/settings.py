"""Environment -> frozen settings, one model per service, each default written once."""

from __future__ import annotations

import os
from pathlib import Path

from pydantic import Field, SecretStr
from pydantic_settings import BaseSettings, SettingsConfigDict

PROJECT_ROOT = Path(__file__).resolve().parent.parent
"""Where `rules/` and `ontology/` lie: the checkout, or site-packages of a wheel."""


def environment(service: str) -> SettingsConfigDict:
    """Return the configuration for settings read from `SPARGE_<SERVICE>_*`."""
    return SettingsConfigDict(env_prefix=f"SPARGE_{service.upper()}_")


def processors() -> int:
    """Return how many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class ServiceSettings(BaseSettings):
    """What every service can be told.

    Attributes
    ----------
    max_body_bytes : int
        A larger request body is refused with 413 before it is read whole.
    max_unpacked_bytes : int
        A compressed body that unpacks to more is refused with 413.
    max_running : int or None
        So many requests are worked on at once; None: as many as there are processors.
    max_waiting : int
        So many more may wait for their turn.
    queue_wait_s : float
        One that would have to wait longer is told at once to come again (429).
    body_time_s : float
        A body that takes longer to arrive is given up (408).
    stage_secret : SecretStr or None
        From `SPARGE_STAGE_SECRET`, for all services: with it stages answer only who sends it,
        and the gateway does.
    """

    model_config = SettingsConfigDict(
        env_prefix="SPARGE_", frozen=True, extra="ignore", populate_by_name=True
    )

    max_body_bytes: int = Field(default=64 * 2**20, gt=0)
    max_unpacked_bytes: int = Field(default=256 * 2**20, gt=0)
    max_running: int | None = Field(default=None, ge=1)
    max_waiting: int = Field(default=64, ge=0)
    queue_wait_s: float = Field(default=2.0, ge=0)
    body_time_s: float = Field(default=30.0, gt=0)
    stage_secret: SecretStr | None = Field(
        default=None, min_length=16, validation_alias="SPARGE_STAGE_SECRET"
    )

    @property
    def concurrency(self) -> int:
        """How many requests are worked on at once."""
        return self.max_running or processors()
