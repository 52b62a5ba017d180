"""How a service is served and called: the application factory and the typed client."""

from shared.service.client import Stage, StageClient
from shared.service.handover import LocalStage
from shared.service.stage import bind, create_service

__all__ = ["LocalStage", "Stage", "StageClient", "bind", "create_service"]
