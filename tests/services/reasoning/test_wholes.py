"""Pieces that go on as each other end are one part, and the answer says so."""

from __future__ import annotations

import numpy as np
import pytest

from services.reasoning.bodies import Bodies
from services.reasoning.continuity import continuities
from services.reasoning.reasoner import Reasoner
from services.reasoning.wholes import as_they_are, joined
from shared.geometry.rotation import matrix_from_quaternion, quaternion_from_matrix
from shared.schemas.primitive import Joint, Primitive
from shared.schemas.task import DecideRequest, DecideResponse, RuleSet, Version
from tests.services.reasoning.objects import (
    BOTTLE,
    HAMMER,
    KNIFE,
    LADLE,
    MUG,
    PAN,
    SCISSORS,
    SCREWDRIVER,
    TURNER,
    part,
)

OBJECTS = (PAN, HAMMER, BOTTLE, LADLE, TURNER, KNIFE, SCREWDRIVER, SCISSORS)
TASKS = ("cooking", "hammering", "pouring", "scooping", "turning", "cutting", "handover")


def halves(whole: Primitive, other: int, turn: float = 0.0) -> tuple[Primitive, Primitive]:
    """Cut a part in the middle of its longest axis; the second half has the id `other`.

    It is turned by `turn` radians about that axis, which shows only in its parameters.
    """
    shape = whole.superquadric
    axis = int(np.argmax(shape.full_extents))
    x, y, z = (each / 2 if k == axis else each for k, each in enumerate(whole.full_extents))
    size = (x, y, z)
    step = shape.rotation[:, axis] * size[axis] / 2
    spin = np.zeros(4)
    spin[axis], spin[3] = np.sin(turn / 2), np.cos(turn / 2)
    found = []
    for number, sign, rotation in (
        (whole.id, 1, shape.rotation),
        (other, -1, shape.rotation @ matrix_from_quaternion(spin)),
    ):
        position = tuple((np.array(shape.position) + sign * step).tolist())
        found.append(
            part(
                number,
                size,
                whole.shape_class,
                position=position,
                quaternion=quaternion_from_matrix(rotation).tolist(),
            ).model_copy(update={"support": whole.support // 2, "holes": whole.holes})
        )
    return found[0], found[1]


def decide(
    reasoner: Reasoner,
    task: str,
    parts: tuple[Primitive, ...],
    version: Version = "v2",
    rule_set: RuleSet = "default",
) -> DecideResponse:
    return reasoner.decide(
        DecideRequest(task=task, reasoning=version, primitives=parts, rule_set=rule_set)
    )


@pytest.mark.parametrize("version", ["v1", "v2"])
@pytest.mark.parametrize("number", range(len(OBJECTS)))
def test_an_object_with_a_part_in_two_is_held_as_the_whole_one(
    reasoner: Reasoner, number: int, version: Version
) -> None:
    whole = OBJECTS[number]
    for cut in range(len(whole)):
        first, second, last = whole[cut].full_extents
        round_along = whole[cut].shape_class != "cuboid" and first == second < last
        pieces = halves(whole[cut], 9, turn=0.4 if round_along else 0.0)
        if whole[cut].holes:
            continue  # half a pair of rings has one opening
        others = tuple(each for each in whole if each.id != cut)
        for task in TASKS:
            before = decide(reasoner, task, whole, version)
            after = decide(reasoner, task, (*others, *pieces), version)
            assert after.found == before.found, (task, cut)
            if before.region is not None and after.region is not None:
                want = set(before.region.primitive_ids)
                assert set(after.region.primitive_ids) == want | ({9} if cut in want else set())
                assert after.region.primitive_ids == tuple(
                    dict.fromkeys(after.region.primitive_ids)
                )


def test_the_answer_says_which_pieces_are_one(reasoner: Reasoner) -> None:
    body, cap = BOTTLE
    answer = decide(reasoner, "pouring", (*halves(body, 7), cap))
    assert answer.region is not None
    assert answer.explanation is not None
    assert set(answer.region.primitive_ids) == {0, 7}
    assert "Parts 0 and 7 continue each other and count as one" in answer.explanation.text
    assert answer.labels[0] == answer.labels[7]
    rule = next(each for each in answer.explanation.rules if each.rule.endswith("one_with"))
    assert rule.holds
    likeness = next(each for each in rule.conditions if "likeness" in each.predicate)
    assert likeness.margin is not None
    assert likeness.margin > 0.2


def test_the_thesis_takes_every_piece_for_a_part(reasoner: Reasoner) -> None:
    body, cap = BOTTLE
    answer = decide(reasoner, "pouring", (*halves(body, 7), cap), rule_set="thesis")
    assert answer.explanation is not None
    assert "continue each other" not in answer.explanation.text
    assert answer.labels.keys() == {0, 1, 7}


@pytest.mark.parametrize("thing", [*OBJECTS, MUG], ids=lambda thing: thing[0].shape_class)
def test_halves_put_together_are_the_part(thing: tuple[Primitive, ...]) -> None:
    for whole in thing:
        one, other = halves(whole, 9)
        found = joined(
            (one, other), (Joint(primitive_ids=(whole.id, 9), position=(0, 0, 0)),), [[whole.id, 9]]
        )
        (again,) = found.primitives
        assert found.joints == ()
        assert found.ids([again.id]) == (whole.id, 9)
        np.testing.assert_allclose(
            sorted(again.full_extents), sorted(whole.full_extents), rtol=1e-6
        )
        np.testing.assert_allclose(
            again.superquadric.position, whole.superquadric.position, atol=1e-9
        )
        rotation = again.superquadric.rotation
        np.testing.assert_allclose(np.linalg.det(rotation), 1.0, atol=1e-9)


def test_joints_lead_to_the_whole() -> None:
    one, other = halves(PAN[1], 5)
    joints = (
        Joint(primitive_ids=(0, 5), position=(0.1, 0, 0.8)),
        Joint(primitive_ids=(1, 5), position=(0.2, 0, 0.8)),
    )
    found = joined((PAN[0], one, other), joints, [[1, 5]])
    assert [each.primitive_ids for each in found.joints] == [(0, 1)]
    assert [each.id for each in found.primitives] == [0, 1]
    alone = as_they_are(PAN, ())
    assert alone.ids([1, 0]) == (1, 0)
    assert alone.part(1) is PAN[1]


@pytest.mark.parametrize("scale", [0.2, 1.0, 5.0])
def test_continuity_has_no_scale_and_no_order(scale: float) -> None:
    def bar(x: float, length: float, width: float, number: int) -> Primitive:
        return part(
            number,
            (scale * length, scale * width, scale * 0.02),
            "cuboid",
            position=(scale * x, 0.0, 0.0),
        )

    flush, thin, there = bar(0, 0.1, 0.03, 0), bar(0.1, 0.1, 0.015, 1), bar(0.1, 0.1, 0.03, 2)
    bodies = Bodies.of([each.superquadric for each in (flush, thin, there)])
    same, other, turned = continuities(bodies, [(0, 2), (0, 1), (1, 0)])
    np.testing.assert_allclose(same, (1.0, 1.0, 0.0), rtol=0.02, atol=1e-3)
    assert other.likeness == pytest.approx(0.5, rel=0.05)
    assert other == turned
