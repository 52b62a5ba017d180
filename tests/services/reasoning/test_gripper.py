"""Rules that mind whether a part goes between the fingers."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from services.reasoning.reasoner import Reasoner
from shared.schemas.primitive import Primitive
from shared.schemas.rule import RuleDefinition
from shared.schemas.task import DecideRequest, DecideResponse, Version
from tests.services.reasoning.objects import BOTTLE, CAN, part

TWO_POSTS = (
    part(0, (0.09, 0.09, 0.2), position=(0.0, 0.0, 0.8)),
    part(1, (0.04, 0.04, 0.2), position=(0.0, 0.3, 0.8)),
)


def decide(
    reasoner: Reasoner,
    task: str,
    parts: tuple[Primitive, ...],
    opening: float | None,
    version: Version = "v1",
) -> DecideResponse:
    return reasoner.decide(
        DecideRequest(task=task, primitives=parts, gripper_opening=opening, reasoning=version)
    )


def teach(reasoner: Reasoner, *conditions: dict[str, object]) -> None:
    reasoner.add_rule(
        RuleDefinition.model_validate(
            {"name": "posts", "task": "lifting", "conditions": list(conditions)}
        )
    )


def test_a_rule_asks_whether_a_part_fits(reasoner: Reasoner) -> None:
    teach(reasoner, {"condition": "fits_gripper"})
    answer = decide(reasoner, "lifting", TWO_POSTS, 0.08)
    assert answer.region is not None
    assert answer.region.primitive_ids == (1,)
    assert answer.explanation is not None
    assert (
        "fits between the fingers (40 mm where the gripper opens 80 mm)" in answer.explanation.text
    )
    (condition,) = answer.explanation.rules[0].conditions
    assert condition.margin == pytest.approx(0.04)
    assert condition.unit == "m"


def test_a_part_that_does_not_fit_says_by_how_much(reasoner: Reasoner) -> None:
    teach(reasoner, {"condition": "fits_gripper"})
    answer = decide(reasoner, "lifting", TWO_POSTS[:1], 0.08)
    assert not answer.found
    assert answer.explanation is not None
    assert "it were 10 mm thinner, to fit between the fingers" in answer.explanation.text
    assert answer.explanation.nearest_miss is not None
    assert answer.explanation.nearest_miss.conditions[0].margin == pytest.approx(-0.01)


def test_without_a_known_opening_nothing_speaks_against_a_part(reasoner: Reasoner) -> None:
    teach(reasoner, {"condition": "fits_gripper"})
    assert decide(reasoner, "lifting", TWO_POSTS, None).found


@pytest.mark.parametrize(("opening", "found"), [(0.1, True), (0.06, True), (0.045, False)])
def test_a_rule_asks_for_room(reasoner: Reasoner, opening: float, found: bool) -> None:
    teach(reasoner, {"condition": "max_gripper_share", "value": 0.8})
    assert decide(reasoner, "lifting", TWO_POSTS, opening).found == found
    assert not decide(reasoner, "lifting", TWO_POSTS, None).found


@pytest.mark.parametrize("version", ["v1", "v2"])
@pytest.mark.parametrize("thing", [BOTTLE, CAN], ids=["bottle", "can"])
def test_shipped_rules_refuse_nothing_for_its_thickness_but_say_it(
    reasoner: Reasoner, thing: tuple[Primitive, ...], version: Version
) -> None:
    free = decide(reasoner, "pouring", thing, None, version)
    wide = decide(reasoner, "pouring", thing, 0.08, version)
    tight = decide(reasoner, "pouring", thing, 0.05, version)
    assert free.region == wide.region == tight.region
    assert free.explanation is not None
    assert wide.explanation is not None
    assert tight.explanation is not None
    assert wide.explanation.text == free.explanation.text
    assert "would fit between the fingers if it were" in tight.explanation.text
    assert "gripper_opening(0.05)" in tight.explanation.facts


def test_of_equals_the_one_that_fits_comes_first(reasoner: Reasoner) -> None:
    teach(reasoner, {"condition": "largest"}, {"condition": "max_length", "value": 0.5})
    twins = (
        part(0, (0.09, 0.09, 0.1), "cuboid", position=(0.0, 0.0, 0.8)),
        part(1, (0.045, 0.18, 0.1), "cuboid", position=(0.0, 0.3, 0.8)),
    )

    def order(opening: float | None) -> list[tuple[int, ...]]:
        answer = reasoner.decide(
            DecideRequest(
                task="lifting",
                primitives=twins,
                gripper_opening=opening,
                reasoning="v1",
                rule_set="thesis",
            )
        )
        assert answer.region is not None
        return [each.primitive_ids for each in (answer.region, *answer.alternatives)]

    assert order(None) == [(0,), (1,)]
    assert order(0.08) == [(1,), (0,)]


@pytest.mark.parametrize("opening", [0, -0.1, float("inf"), float("nan")])
def test_an_opening_is_a_length(opening: float) -> None:
    with pytest.raises(ValidationError):
        DecideRequest(task="pouring", primitives=(), gripper_opening=opening)
