"""Explanations are kept for a while, a bounded number of them."""

from __future__ import annotations

from typing import Any

import pytest

from services.gateway.memory import Memory
from shared.errors import NotFound
from shared.schemas.answer import GraspAnswer
from shared.schemas.task import Explanation


def answer(request_id: str, text: str = "because", explained: bool = True) -> GraspAnswer:
    explanation = Explanation(text=text, facts=(), rules=()) if explained else None
    fields: dict[str, Any] = {
        "request_id": request_id,
        "task": "pouring",
        "reasoning": "v2",
        "rule_set": "default",
        "found": False,
        "reason": None,
        "region": None,
        "alternatives": (),
        "explanation": explanation,
    }
    return GraspAnswer.model_construct(**fields)


def test_what_is_kept_is_what_was_said() -> None:
    memory = Memory(2, 60)
    memory.keep(answer("a", "because of the handle"))
    kept = memory.recall("a")
    assert kept.explanation.text == "because of the handle"
    assert (kept.request_id, kept.task, kept.rule_set) == ("a", "pouring", "default")


def test_the_oldest_is_forgotten() -> None:
    memory = Memory(2, 60)
    for name in "abc":
        memory.keep(answer(name))
    assert memory.recall("b").request_id == "b"
    assert memory.recall("c").request_id == "c"
    with pytest.raises(NotFound, match="'a'"):
        memory.recall("a")


def test_an_id_used_again_counts_once_and_as_new() -> None:
    memory = Memory(2, 60)
    for name in "abac":
        memory.keep(answer(name))
    assert memory.recall("a").request_id == "a"
    with pytest.raises(NotFound):
        memory.recall("b")


def test_it_is_kept_for_a_while() -> None:
    now = [0.0]
    memory = Memory(9, 60, clock=lambda: now[0])
    memory.keep(answer("a"))
    now[0] = 50.0
    memory.keep(answer("b"))
    now[0] = 61.0
    with pytest.raises(NotFound):
        memory.recall("a")
    assert memory.recall("b").request_id == "b"


def test_nothing_is_kept_without_an_explanation() -> None:
    memory = Memory(9, 60)
    memory.keep(answer("a", explained=False))
    with pytest.raises(NotFound):
        memory.recall("a")


def test_none_at_all() -> None:
    memory = Memory(0, 60)
    memory.keep(answer("a"))
    with pytest.raises(NotFound, match="the last 0 are"):
        memory.recall("a")
