"""How a service is served and called: the application factory and the typed client."""

from shared.service.client import StageClient
from shared.service.stage import bind, create_service

__all__ = ["StageClient", "bind", "create_service"]
