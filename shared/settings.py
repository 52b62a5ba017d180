"""Environment -> frozen settings, one model per service, each default written once."""

from __future__ import annotations

from pathlib import Path

from pydantic import Field
from pydantic_settings import BaseSettings, SettingsConfigDict

PROJECT_ROOT = Path(__file__).resolve().parent.parent
"""Where `rules/` and `ontology/` lie: the checkout, or site-packages of a wheel."""


def environment(service: str) -> SettingsConfigDict:
    """Return the configuration for settings read from `SPARGE_<SERVICE>_*`."""
    return SettingsConfigDict(env_prefix=f"SPARGE_{service.upper()}_", frozen=True, extra="ignore")


class ServiceSettings(BaseSettings):
    """What every service can be told.

    Attributes
    ----------
    max_body_bytes : int
        A larger request body is refused with 413 before it is read whole.
    max_unpacked_bytes : int
        A compressed body that unpacks to more is refused with 413.
    """

    max_body_bytes: int = Field(default=64 * 2**20, gt=0)
    max_unpacked_bytes: int = Field(default=256 * 2**20, gt=0)
