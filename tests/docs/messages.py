"""JSON on a page is a message of the public interface, or a file that a command reads."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ValidationError

from services.gateway.kserve.messages import InferRequest
from shared.schemas.execution import ExecuteRequest
from shared.schemas.point_cloud2 import PointCloud2
from shared.schemas.primitive import EmsParameters
from shared.schemas.rule import AffordanceDefinition, RuleDefinition
from shared.schemas.task import TaskDefinition

MESSAGES: tuple[type[BaseModel], ...] = (
    AffordanceDefinition,
    EmsParameters,
    ExecuteRequest,
    InferRequest,
    PointCloud2,
    RuleDefinition,
    TaskDefinition,
)


def kind_of(content: Any) -> str | None:
    """Return which message this is; None if it is none."""
    for message in MESSAGES:
        try:
            message.model_validate(content)
        except ValidationError:
            continue
        return message.__name__
    if isinstance(content, dict) and set(content) == {"error"}:
        error = content["error"]
        return "error" if {"code", "message", "details", "request_id"} <= set(error) else None
    return None
