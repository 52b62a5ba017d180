"""Which parts meet."""

from __future__ import annotations

import pytest

from services.reasoning.contact import TOUCHING, TOUCHING_M, touching
from shared.schemas.primitive import Joint, Primitive
from tests.services.reasoning.objects import BOTTLE, HAMMER, KNIFE, LADLE, PAN, part


@pytest.mark.parametrize("primitives", [PAN, HAMMER, BOTTLE, LADLE, KNIFE])
def test_parts_of_an_object_meet(primitives: tuple[Primitive, ...]) -> None:
    assert touching(primitives, ()) == ((0, 1),)


@pytest.mark.parametrize(("gap", "meet"), [(0.0, True), (0.005, True), (0.03, False)])
def test_the_gap_decides(gap: float, meet: bool) -> None:
    pair = (
        part(0, (0.04, 0.04, 0.1), "cuboid"),
        part(1, (0.04, 0.04, 0.1), "cuboid", position=(0.0, 0.0, 0.9 + gap)),
    )
    assert max(TOUCHING_M, TOUCHING * 0.04) == 0.006
    assert touching(pair, ()) == (((0, 1),) if meet else ())


def test_overlap_is_contact() -> None:
    inside = (part(0, (0.1, 0.1, 0.1)), part(1, (0.02, 0.02, 0.02)))
    assert touching(inside, ()) == ((0, 1),)


def test_joints_decide_where_there_are_any() -> None:
    three = (*BOTTLE, part(2, (0.03, 0.03, 0.03), position=(1.0, 0.0, 0.8)))
    joint = Joint(primitive_ids=(2, 0), position=(0.0, 0.0, 0.0))
    assert touching(three, (joint,)) == ((0, 2),)


def test_a_joint_of_an_unknown_part_is_passed_over() -> None:
    joint = Joint(primitive_ids=(0, 9), position=(0.0, 0.0, 0.0))
    assert touching(BOTTLE, (joint,)) == ()
