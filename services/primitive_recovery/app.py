"""The HTTP face of the primitive recovery."""

from __future__ import annotations

from fastapi import FastAPI

from services.primitive_recovery.recovery import PrimitiveRecovery
from services.primitive_recovery.settings import PrimitiveRecoverySettings
from shared.schemas.primitive import RECOVER
from shared.service import bind, create_service


def create_app(settings: PrimitiveRecoverySettings | None = None) -> FastAPI:
    """Return the service, ready to be run by uvicorn."""
    settings = settings or PrimitiveRecoverySettings()
    stage = PrimitiveRecovery(settings)
    return create_service(
        "primitive_recovery",
        "Decompose an object's visible points into superquadrics and name their shapes",
        settings,
        handlers=[bind(RECOVER, stage.recover)],
        warm_up=stage.warm_up,
        afterwards=stage.warm_up_ems,
    )
