"""The execution service: `uvicorn --factory services.execution.app:create_app`."""

from __future__ import annotations

from fastapi import FastAPI

from services.execution.executor import Executor
from services.execution.settings import ExecutionSettings
from shared.schemas.execution import EXECUTE
from shared.service import bind, create_service


def create_app(settings: ExecutionSettings | None = None) -> FastAPI:
    """Return the execution service."""
    settings = settings or ExecutionSettings()
    executor = Executor(settings)
    return create_service(
        "execution",
        "Replays a grasp with a Panda arm in simulation and says whether it lifted the object",
        settings,
        handlers=[bind(EXECUTE, executor.execute)],
        warm_up=executor.warm_up,
        close=executor.close,
    )
