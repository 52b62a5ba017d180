"""The reasoning service's application."""

from __future__ import annotations

from fastapi import FastAPI

from services.reasoning.reasoner import Reasoner
from services.reasoning.settings import ReasoningSettings
from shared.schemas.task import ADD_TASK, DECIDE, DELETE_TASK, LIST_AFFORDANCES, LIST_TASKS
from shared.service import bind, create_service


def create_app(settings: ReasoningSettings | None = None) -> FastAPI:
    """Return the service; without settings they are read from the environment."""
    settings = settings or ReasoningSettings()
    reasoner = Reasoner(settings)
    return create_service(
        "reasoning",
        "Finds the part to hold for a task, by rules proved in Prolog",
        settings,
        handlers=[
            bind(DECIDE, reasoner.decide),
            bind(LIST_TASKS, reasoner.list_tasks),
            bind(ADD_TASK, reasoner.add_task),
            bind(DELETE_TASK, reasoner.delete_task),
            bind(LIST_AFFORDANCES, reasoner.list_affordances),
        ],
        warm_up=reasoner.warm_up,
        close=reasoner.close,
    )
