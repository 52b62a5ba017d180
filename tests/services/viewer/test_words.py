"""Answers in Markdown: what is told, and that nothing in it is markup by accident."""

from __future__ import annotations

import pytest

from services.viewer.words import answer_in_words, error_in_words, margin
from shared.client import Sparge
from shared.errors import UnknownTask
from shared.schemas.rehearsal import Rehearsal
from shared.schemas.task import Condition
from tests.support.samples import sample_view
from tests.support.serving import Client


def condition(margin: float | None, unit: str | None) -> Condition:
    return Condition(
        predicate="at_least(width(ID), 0.045)",
        primitive_id=0,
        holds=True,
        measured="0.065 m",
        required=">= 0.045 m",
        margin=margin,
        unit=unit,
    )


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [(0.0204, "m", "+20.4 mm"), (-0.9, "ratio", "-0.9"), (None, None, ""), (2e-6, "m3", "+2 cm³")],
)
def test_margins_are_in_units_of_people(value: float | None, unit: str | None, text: str) -> None:
    assert margin(condition(value, unit)) == text


def test_an_answer_tells_every_condition(backend: Client) -> None:
    answer = Sparge(backend.request).grasp(sample_view("bottle"), "pouring").answer
    words = answer_in_words(answer)
    assert answer.explanation is not None
    conditions = [each for rule in answer.explanation.rules for each in rule.conditions]
    assert words.count("| ✓ |") == len(conditions) > 4
    assert r"width(ID) \>= 0.045 m" in words
    assert "hold part 0" in words


def test_what_does_not_fit_tells_what_came_closest(backend: Client) -> None:
    answer = Sparge(backend.request).grasp(sample_view("bottle"), "hammering").answer
    words = answer_in_words(answer)
    assert "**Nearest miss**" in words
    assert "| ✗ |" in words


def test_what_was_tried_in_simulation_is_told(backend: Client) -> None:
    sparge = Sparge(backend.request)
    answer = sparge.grasp(sample_view("saucepan"), "cooking", rehearsal="always").answer
    came = ", ".join(each.replace("_", " ") for each in answer.grasps[0].rehearsed)
    assert f"*Tried in simulation before the answer: rank 0: {came}" in answer_in_words(answer)
    stopped = Rehearsal(tried=0, stopped="stage_unavailable")
    none = tuple(each.model_copy(update={"rehearsed": ()}) for each in answer.grasps)
    words = answer_in_words(answer.model_copy(update={"grasps": none, "rehearsal": stopped}))
    assert r"before the answer: ended by stage\_unavailable*" in words
    never = sparge.grasp(sample_view("saucepan"), "cooking", rehearsal="never").answer
    assert "simulation" not in answer_in_words(never)


def test_an_error_is_told_with_its_code() -> None:
    error = UnknownTask("unknown task 'a*b'; known are [pouring]")
    assert error_in_words(error) == r"**unknown_task**: unknown task 'a\*b'; known are \[pouring\]"
