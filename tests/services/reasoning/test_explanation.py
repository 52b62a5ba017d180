"""The paragraph that a person reads."""

from __future__ import annotations

import pytest

from services.reasoning.phrases import millimetres
from services.reasoning.reasoner import Reasoner
from services.reasoning.wording import apart, joined
from shared.schemas.primitive import Primitive
from shared.schemas.task import DecideRequest, Version
from tests.services.reasoning.objects import (
    BOTTLE,
    HAMMER,
    PAN,
    PAN_WITH_FAT_HANDLE,
    part,
)


def text(reasoner: Reasoner, task: str, version: Version, primitives: tuple[Primitive, ...]) -> str:
    request = DecideRequest(task=task, reasoning=version, primitives=primitives, rule_set="thesis")
    explanation = reasoner.decide(request).explanation
    assert explanation is not None
    return explanation.text


def test_version_1_found(reasoner: Reasoner) -> None:
    said = text(reasoner, "cooking", "v1", PAN)
    assert said.startswith("Hold part 1 for cooking. The rule thesis/version1:cooking holds: ")
    assert "part 0 (a cylinder of 60 x 180 x 180 mm) is at least 0 x 80 x 80 mm" in said
    assert "is at most 50 x 50 x 1000 mm (20 mm to spare)" in said


def test_version_2_found(reasoner: Reasoner) -> None:
    said = text(reasoner, "cooking", "v2", PAN)
    assert said.startswith("Hold part 1 for cooking: it is the part to grasp.")
    assert "what the task requires: contain (part 0) and grasp (part 1)" in said


def test_missed_by_a_few_millimetres(reasoner: Reasoner) -> None:
    said = text(reasoner, "cooking", "v1", PAN_WITH_FAT_HANDLE)
    assert "could be held for cooking if it were 4 mm narrower" in said
    assert "(54 mm where at most 50 mm is asked)" in said


def test_missed_for_want_of_a_part(reasoner: Reasoner) -> None:
    said = text(reasoner, "hammering", "v1", HAMMER[1:])
    assert "if the object had another part for the other role" in said


def test_missed_by_shape(reasoner: Reasoner) -> None:
    handle = part(1, (0.02, 0.03, 0.2), "cuboid")
    said = text(reasoner, "cooking", "v1", (PAN[0], handle))
    assert "if it were a cylinder instead of a cuboid" in said


def test_missed_by_size_among_the_parts(reasoner: Reasoner) -> None:
    said = text(reasoner, "hammering", "v1", PAN)
    assert "if it were the largest part" in said


def test_handover_says_why_a_part_may_be_held(reasoner: Reasoner) -> None:
    said = text(reasoner, "handover", "v2", BOTTLE)
    assert said.startswith("Hold part 1 for handover.")
    assert "part 1 does not count as wrap_grasp, which it would if it were 20 mm thicker" in said


def test_a_close_call_is_named(reasoner: Reasoner) -> None:
    tight = (PAN[0], part(1, (0.02, 0.049, 0.2)))
    said = text(reasoner, "cooking", "v1", tight)
    assert "The closest call: part 1 is at most 50 x 50 x 1000 mm (1 mm to spare)." in said


def test_facts_are_those_that_prolog_saw(reasoner: Reasoner) -> None:
    request = DecideRequest(
        task="handover", reasoning="v2", primitives=BOTTLE[:1], rule_set="thesis"
    )
    explanation = reasoner.decide(request).explanation
    assert explanation is not None
    stated = set(explanation.facts)
    assert {
        "primitive_values(0,[0.0,0.0,0.8],[0.07,0.07,0.2],[0.1,1.0],cylinder)",
        "holes(0,0)",
        "triple(handover,type,'Task')",
        "triple(handover,avoidsAffordance,wrap_grasp)",
    } <= stated
    assert not any(fact.startswith("stands(") for fact in stated), "no plane, no heights"
    assert len(stated) == len(explanation.facts)


@pytest.mark.parametrize(
    ("metres", "said"), [(0.0321, "32"), (0.004, "4"), (0.00035, "0.35"), (0.0, "0"), (1.0, "1000")]
)
def test_millimetres(metres: float, said: str) -> None:
    assert millimetres(metres) == said


@pytest.mark.parametrize(
    ("value", "bound", "said"),
    [(54.2, 50, "54"), (14.94, 15, "14.9"), (1.999, 2, "1.999"), (2.0, 2, "2")],
)
def test_apart(value: float, bound: float, said: str) -> None:
    assert apart(value, bound) == said


def test_joined() -> None:
    assert [joined([]), joined(["a"]), joined("ab"), joined("abc")] == [
        "",
        "a",
        "a and b",
        "a, b and c",
    ]
