"""Primitives that cannot be reasoned about are refused before Prolog sees them."""

from __future__ import annotations

import pytest

from services.reasoning.facts import facts_of, layout_facts
from shared.errors import InvalidInput
from shared.schemas.primitive import Joint, Primitive
from tests.services.reasoning.objects import PAN, part


def changed(primitive: Primitive, **fields: object) -> Primitive:
    return Primitive.model_validate({**primitive.model_dump(), **fields})


def test_dimensions_are_full_extents() -> None:
    facts = facts_of(PAN, 8)
    assert facts[1]["dimensions"] == [0.02, 0.03, 0.2]
    assert facts[1]["id"] == 1
    assert facts[1]["position"] == [0.19, 0.0, 0.8]
    assert facts[1]["exponents"] == [0.1, 1.0]


def test_semi_axes_in_place_of_extents_are_found_out() -> None:
    halved = changed(PAN[0], full_extents=[0.09, 0.09, 0.03])
    with pytest.raises(InvalidInput, match="twice the semi-axis") as caught:
        facts_of([halved], 8)
    assert caught.value.details["field"] == "primitives.0.full_extents"


@pytest.mark.parametrize("extent", [0.0, -0.1, 1e-9, 1e5])
def test_extents_are_lengths(extent: float) -> None:
    with pytest.raises(InvalidInput, match="extents are metres"):
        facts_of([part(0, (extent, 0.1, 0.1))], 8)


@pytest.mark.parametrize("exponent", [0.0, -1.0, 3.0])
def test_exponents_are_those_of_a_superquadric(exponent: float) -> None:
    parameters = (exponent, *PAN[0].parameters[1:])
    with pytest.raises(InvalidInput, match="exponents"):
        facts_of([changed(PAN[0], parameters=parameters)], 8)


def test_ids_differ() -> None:
    with pytest.raises(InvalidInput, match="more than once"):
        facts_of([part(3, (0.1, 0.1, 0.1)), part(3, (0.2, 0.2, 0.2))], 8)


def test_too_many() -> None:
    with pytest.raises(InvalidInput, match="too many"):
        facts_of([part(number, (0.1, 0.1, 0.1)) for number in range(9)], 8)


def test_no_parts_lie_nowhere() -> None:
    assert layout_facts((), (), None) is None


def test_layout_names_parts_by_their_ids() -> None:
    renamed = tuple(each.model_copy(update={"id": each.id + 5}) for each in PAN)
    stated = layout_facts(renamed, (), None)
    assert stated is not None
    assert [each["id"] for each in stated["parts"]] == [5, 6]
    assert sorted(pair[:2] for pair in stated["pairs"]) == [[5, 6], [6, 5]]
    assert [each[:2] for each in stated["meeting"]] == [[5, 6]]
    assert stated["length"] == pytest.approx(0.38)
    assert sum(each["seen"] for each in stated["parts"]) == pytest.approx(1.0)


def test_joints_of_the_recovery_decide() -> None:
    apart = (PAN[0], part(1, (0.02, 0.03, 0.2), position=(0.5, 0.0, 0.8)))
    joint = Joint(primitive_ids=(1, 0), position=(0.2, 0.0, 0.8))
    without, with_joint = layout_facts(apart, (), None), layout_facts(apart, (joint,), None)
    assert without is not None
    assert with_joint is not None
    assert without["meeting"] == []
    assert [each[:2] for each in with_joint["meeting"]] == [[0, 1]]
