"""The perception service: `uvicorn --factory services.perception.app:create_app`."""

from __future__ import annotations

from fastapi import FastAPI

from services.perception.perceive import Perception
from services.perception.settings import PerceptionSettings
from shared.schemas.scene import PERCEIVE
from shared.service import bind, create_service


def create_app(settings: PerceptionSettings | None = None) -> FastAPI:
    """Return the service, ready once the stage has run once."""
    settings = settings or PerceptionSettings()
    stage = Perception(settings)
    return create_service(
        "perception",
        "Find the support plane and the target object in one view",
        settings,
        handlers=[bind(PERCEIVE, stage.perceive)],
        warm_up=stage.warm_up,
    )
