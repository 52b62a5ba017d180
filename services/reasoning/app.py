"""The reasoning service's application."""

from __future__ import annotations

from fastapi import FastAPI

from services.reasoning.reasoner import Reasoner
from services.reasoning.settings import ReasoningSettings
from shared.schemas.knowledge import (
    ASK_QUESTION,
    EXPORT_KNOWLEDGE,
    IMPORT_KNOWLEDGE,
    LIST_QUESTIONS,
    QUERY_KNOWLEDGE,
)
from shared.schemas.rule import (
    ADD_AFFORDANCE,
    ADD_RULE,
    DELETE_AFFORDANCE,
    DELETE_RULE,
    LIST_RULES,
)
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
            bind(ADD_AFFORDANCE, reasoner.add_affordance),
            bind(DELETE_AFFORDANCE, reasoner.delete_affordance),
            bind(LIST_RULES, reasoner.list_rules),
            bind(ADD_RULE, reasoner.add_rule),
            bind(DELETE_RULE, reasoner.delete_rule),
            bind(EXPORT_KNOWLEDGE, reasoner.export_knowledge),
            bind(IMPORT_KNOWLEDGE, reasoner.import_knowledge),
            bind(QUERY_KNOWLEDGE, reasoner.query_knowledge),
            bind(LIST_QUESTIONS, reasoner.list_questions),
            bind(ASK_QUESTION, reasoner.ask_question),
        ],
        warm_up=reasoner.warm_up,
        close=reasoner.close,
    )
