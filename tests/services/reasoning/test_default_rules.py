"""The rule set `default`: what is held, what is refused, and what is said about it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from services.reasoning.reasoner import Reasoner
from services.reasoning.reasons import CODES
from shared.geometry.rotation import matrix_from_quaternion, quaternion_from_matrix
from shared.schemas.primitive import Primitive
from shared.schemas.task import DecideRequest, DecideResponse, Version
from tests.services.reasoning.objects import (
    BOTTLE,
    CAN,
    CARTON,
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

Parts = tuple[Primitive, ...]

VERSIONS: tuple[Version, ...] = ("v1", "v2")
HELD: list[tuple[str, Parts, tuple[int, ...]]] = [
    ("cooking", PAN, (1,)),
    ("handover", PAN, (0,)),
    ("scooping", LADLE, (1,)),
    ("handover", LADLE, (0,)),
    ("turning", TURNER, (1,)),
    ("handover", TURNER, (0,)),
    ("hammering", HAMMER, (0,)),
    ("handover", HAMMER, (1,)),
    ("pouring", BOTTLE, (0,)),
    ("handover", BOTTLE, (1,)),
    ("cutting", KNIFE, (1,)),
    ("handover", KNIFE, (0,)),
    ("cutting", SCISSORS, (1,)),
    ("handover", SCISSORS, (0,)),
    ("handover", SCREWDRIVER, (0,)),
    ("pouring", MUG, (1,)),
    ("handover", MUG, (0,)),
    ("pouring", CAN, (0,)),
    ("handover", CAN, (0,)),
    ("handover", CARTON, (0,)),
]
REFUSED: list[tuple[Parts, tuple[str, ...]]] = [
    (PAN, ("cutting", "hammering", "scooping")),
    (LADLE, ("cutting", "hammering", "cooking", "pouring")),
    (TURNER, ("hammering", "pouring", "cooking", "cutting")),
    (HAMMER, ("cooking", "cutting", "pouring", "scooping", "turning")),
    (BOTTLE, ("cooking", "cutting", "hammering", "scooping", "turning")),
    (KNIFE, ("cooking", "hammering", "pouring", "scooping")),
    (SCISSORS, ("cooking", "hammering", "pouring", "scooping", "turning")),
    (SCREWDRIVER, ("cooking", "cutting", "pouring", "scooping")),
    (MUG, ("cooking", "cutting", "hammering", "turning", "scooping")),
    (CARTON, ("cooking", "cutting", "hammering", "scooping", "turning")),
]


def decide(reasoner: Reasoner, task: str, version: Version, primitives: Parts) -> DecideResponse:
    return reasoner.decide(DecideRequest(task=task, reasoning=version, primitives=primitives))


def held(response: DecideResponse) -> tuple[int, ...]:
    assert response.region is not None, response.reason
    return response.region.primitive_ids


def told(response: DecideResponse) -> str:
    assert response.explanation is not None
    return response.explanation.text


def test_default_is_what_one_gets() -> None:
    assert DecideRequest(task="cooking", primitives=()).rule_set == "default"


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize(("task", "primitives", "expected"), HELD)
def test_held(
    reasoner: Reasoner, task: str, version: Version, primitives: Parts, expected: tuple[int, ...]
) -> None:
    response = decide(reasoner, task, version, primitives)
    assert held(response) == expected
    assert response.region is not None
    assert response.region.confidence > 0.5
    assert response.explanation is not None
    assert all(c.holds for trace in response.explanation.rules for c in trace.conditions)


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize(("primitives", "tasks"), REFUSED)
def test_refused_with_the_nearest_miss(
    reasoner: Reasoner, version: Version, primitives: Parts, tasks: tuple[str, ...]
) -> None:
    for task in tasks:
        response = decide(reasoner, task, version, primitives)
        assert not response.found, task
        assert response.reason is not None
        assert response.reason.code in CODES
        assert response.explanation is not None
        miss = response.explanation.nearest_miss
        assert miss is not None
        assert not all(each.holds for each in miss.conditions)
        assert "nearest miss" in told(response)


def halves(primitives: Parts, number: int) -> Parts:
    """Return the object with one part cut in two across its longest axis."""
    whole = primitives[number]
    shape = whole.superquadric
    axis = int(np.argmax(shape.semi_axes))
    extents = list(shape.full_extents)
    extents[axis] /= 2
    shift = shape.rotation[:, axis] * extents[axis] / 2
    pieces = [
        part(
            number + 100 * side,
            (extents[0], extents[1], extents[2]),
            whole.shape_class,
            position=tuple(np.array(shape.position) + (2 * side - 1) * shift),
            quaternion=shape.quaternion,
        )
        for side in (0, 1)
    ]
    return (*(pieces[0] if each.id == number else each for each in primitives), pieces[1])


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize(
    ("task", "primitives", "cut"),
    [("cooking", PAN, 1), ("scooping", LADLE, 1), ("hammering", HAMMER, 0), ("turning", TURNER, 1)],
)
def test_a_handle_in_two_pieces_is_one_region(
    reasoner: Reasoner, task: str, version: Version, primitives: Parts, cut: int
) -> None:
    response = decide(reasoner, task, version, halves(primitives, cut))
    assert held(response) == (cut, cut + 100)
    assert response.alternatives == ()  # half of it is no alternative


@pytest.mark.parametrize("version", VERSIONS)
def test_handover_offers_all_that_the_person_does_not_take(
    reasoner: Reasoner, version: Version
) -> None:
    assert held(decide(reasoner, "handover", version, halves(PAN, 0))) == (0, 100)


def test_the_only_part_is_handed_over_and_it_is_said_why(reasoner: Reasoner) -> None:
    text = told(decide(reasoner, "handover", "v2", CAN))
    assert "would leave parts that count as wrap_grasp free, but the object offers nothing" in text


def test_a_bottle_that_was_not_cut_is_poured(reasoner: Reasoner) -> None:
    whole = (part(0, (0.07, 0.07, 0.23)),)
    assert held(decide(reasoner, "pouring", "v2", whole)) == (0,)
    assert held(decide(reasoner, "pouring", "v1", whole)) == (0,)


def test_an_uncut_hammer_is_refused(reasoner: Reasoner) -> None:
    whole = (part(0, (0.035, 0.1, 0.33), "cuboid"),)
    for version in VERSIONS:
        assert not decide(reasoner, "hammering", version, whole).found


@pytest.mark.parametrize("version", VERSIONS)
def test_how_far_it_fails_is_said_in_millimetres(reasoner: Reasoner, version: Version) -> None:
    fat = (PAN[0], part(1, (0.07, 0.071, 0.3), position=(0.24, 0.0, 0.8),
                        quaternion=PAN[1].superquadric.quaternion))  # fmt: skip
    text = told(decide(reasoner, "cooking", version, fat))
    assert "if it were 10 mm thinner (70 mm where at most 60 mm is asked)" in text


def test_the_margin_is_in_the_proof(reasoner: Reasoner) -> None:
    response = decide(reasoner, "hammering", "v1", HAMMER)
    assert response.explanation is not None
    (trace,) = response.explanation.rules
    found = {each.predicate: each for each in trace.conditions}
    slant = found["at_least(slant(ID_tool), 45)"]
    assert slant.unit == "deg"
    assert slant.margin == pytest.approx(45.0, abs=1e-3)
    assert slant.primitive_id == 1
    assert found["at_most(thickness(ID), 0.06)"].margin == pytest.approx(0.035)
    assert found["\\+ rings(Tool, ID)"].measured == "part 1 does not count as rings"


def test_why_a_head_is_no_bowl(reasoner: Reasoner) -> None:
    miss = told(decide(reasoner, "scooping", "v2", HAMMER))
    assert "did not count as pound" in miss


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize(("task", "primitives", "expected"), HELD)
def test_order_names_and_place_of_the_parts_do_not_matter(
    reasoner: Reasoner, task: str, version: Version, primitives: Parts, expected: tuple[int, ...]
) -> None:
    rng = np.random.default_rng(len(task))
    quaternion = rng.standard_normal(4)
    rotation = matrix_from_quaternion(quaternion / np.linalg.norm(quaternion))
    names = {each.id: 10 - 3 * each.id for each in primitives}
    turned = []
    for each in reversed(primitives):
        vector = each.superquadric.to_vector()
        vector[5:8] = rotation @ vector[5:8] + (0.1, -0.2, 0.3)
        vector[8:] = quaternion_from_matrix(rotation @ each.superquadric.rotation)
        turned.append(
            each.model_copy(update={"id": names[each.id], "parameters": tuple(vector.tolist())})
        )
    response = decide(reasoner, task, version, tuple(turned))
    assert held(response) == tuple(sorted(names[number] for number in expected))


lengths = st.floats(min_value=0.002, max_value=0.4)
places = st.floats(min_value=-0.2, max_value=0.2)


@given(
    st.lists(
        st.builds(
            part,
            st.just(0),
            st.tuples(lengths, lengths, lengths),
            st.sampled_from(["cuboid", "cylinder", "sphere"]),
            position=st.tuples(places, places, places),
        ),
        max_size=5,
    ),
    st.sampled_from([task for task, _, _ in HELD]),
    st.sampled_from(VERSIONS),
)
@hypothesis_settings(
    max_examples=40,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
def test_any_object_is_answered_or_refused_with_a_reason(
    reasoner: Reasoner, drawn: list[Primitive], task: str, version: Version
) -> None:
    primitives = tuple(each.model_copy(update={"id": number}) for number, each in enumerate(drawn))
    response = decide(reasoner, task, version, primitives)
    assert response.found == (response.region is not None) == (response.reason is None)
    if response.reason is not None:
        assert response.reason.code in CODES
    regions = [*([response.region] if response.region else []), *response.alternatives]
    assert all(0 <= each.confidence <= 1 for each in regions)
    assert all(set(each.primitive_ids) <= {p.id for p in primitives} for each in regions)
    assert told(response)
    assert decide(reasoner, task, version, primitives) == response
