"""What the matching service can be told."""

from __future__ import annotations

from shared.settings import ServiceSettings, environment


class MatchingSettings(ServiceSettings):
    """Limits only: matching has no parameters."""

    model_config = environment("matching")
