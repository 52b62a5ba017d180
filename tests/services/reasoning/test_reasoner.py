"""Which part to hold, in both versions, and what holds whatever the object."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import HealthCheck, given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from services.reasoning.reasoner import Reasoner
from services.reasoning.reasons import CODES
from services.reasoning.settings import ReasoningSettings
from shared.errors import DeadlineExceeded, InvalidInput, UnknownTask
from shared.schemas.primitive import Primitive, ShapeClass
from shared.schemas.task import DecideRequest, DecideResponse, RuleTrace, Version
from shared.settings import PROJECT_ROOT
from tests.services.reasoning.objects import (
    BOTTLE,
    HAMMER,
    KNIFE,
    LADLE,
    PAN,
    PAN_WITH_FAT_HANDLE,
    TURNER,
    part,
)

TASKS = ("cooking", "cutting", "hammering", "handover", "pouring", "scooping", "turning")
VERSIONS: tuple[Version, ...] = ("v1", "v2")

EXPECTED: list[tuple[str, tuple[Primitive, ...], int]] = [
    ("cooking", PAN, 1),
    ("hammering", HAMMER, 0),
    ("pouring", BOTTLE, 0),
    ("scooping", LADLE, 1),
    ("turning", TURNER, 1),
    ("cutting", KNIFE, 1),
]

lengths = st.floats(min_value=0.002, max_value=0.4)
shapes: st.SearchStrategy[ShapeClass] = st.sampled_from(["cuboid", "cylinder", "sphere"])
objects = st.lists(
    st.builds(
        part,
        st.just(0),
        st.tuples(lengths, lengths, lengths),
        shapes,
        st.floats(min_value=0.34, max_value=1.0),
    ),
    max_size=4,
).map(
    lambda parts: tuple(each.model_copy(update={"id": number}) for number, each in enumerate(parts))
)
few_examples = hypothesis_settings(
    max_examples=40,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


def decide(
    reasoner: Reasoner, task: str, version: Version, primitives: tuple[Primitive, ...]
) -> DecideResponse:
    return reasoner.decide(
        DecideRequest(task=task, reasoning=version, primitives=primitives, rule_set="thesis")
    )


def miss_of(response: DecideResponse) -> RuleTrace:
    assert response.explanation is not None
    assert response.explanation.nearest_miss is not None
    return response.explanation.nearest_miss


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize(("task", "primitives", "held"), EXPECTED)
def test_household_objects_are_held_by_the_right_part(
    reasoner: Reasoner,
    task: str,
    primitives: tuple[Primitive, ...],
    held: int,
    version: Version,
) -> None:
    response = decide(reasoner, task, version, primitives)
    assert response.found
    assert response.reason is None
    assert response.region is not None
    assert response.region.primitive_ids == (held,)
    assert 0.5 <= response.region.confidence <= 1


def test_version_1_hands_over_the_smallest_part(reasoner: Reasoner) -> None:
    response = decide(reasoner, "handover", "v1", PAN)
    assert response.region is not None
    assert response.region.primitive_ids == (1,)
    assert response.labels == {}


def test_version_2_hands_over_whatever_is_not_to_be_wrapped(reasoner: Reasoner) -> None:
    response = decide(reasoner, "handover", "v2", HAMMER)
    assert response.region is not None
    assert response.region.primitive_ids == (0, 1)
    assert response.region.affordance is None
    assert decide(reasoner, "handover", "v2", BOTTLE[:1]).reason is not None


def test_version_2_labels_every_part(reasoner: Reasoner) -> None:
    assert decide(reasoner, "cooking", "v2", PAN).labels == {
        0: ("contain", "pound", "wrap_grasp"),
        1: ("grasp", "pound"),
    }


def test_a_blade_is_not_held_even_when_it_could_be_grasped(reasoner: Reasoner) -> None:
    blade = (part(0, (0.006, 0.03, 0.18), "cuboid"),)
    response = decide(reasoner, "cutting", "v2", blade)
    assert set(response.labels[0]) == {"cut", "grasp"}
    assert response.reason is not None
    assert response.reason.code == "every_part_avoided"
    assert miss_of(response).conditions[0].margin is not None


def test_other_parts_that_satisfy_the_rule_are_alternatives_best_first(reasoner: Reasoner) -> None:
    tight, comfortable = part(1, (0.02, 0.049, 0.2)), part(2, (0.02, 0.03, 0.2))
    for version in VERSIONS:
        response = decide(reasoner, "cooking", version, (PAN[0], tight, comfortable))
        assert response.region is not None
        assert response.region.primitive_ids == (2,)
        assert [each.primitive_ids for each in response.alternatives] == [(1,)]
        assert response.region.confidence > response.alternatives[0].confidence


def test_an_unsure_shape_lowers_the_confidence(reasoner: Reasoner) -> None:
    unsure = (PAN[0], part(1, (0.02, 0.03, 0.2), probability=0.6))
    response = decide(reasoner, "cooking", "v1", unsure)
    assert response.region is not None
    assert response.region.confidence == pytest.approx(0.6)


def test_the_nearest_miss_says_which_condition_failed_by_how_much(reasoner: Reasoner) -> None:
    response = decide(reasoner, "cooking", "v1", PAN_WITH_FAT_HANDLE)
    assert response.reason is not None
    assert response.reason.code == "no_part_matches"
    miss = miss_of(response)
    assert miss.rule == "thesis/version1:cooking"
    assert miss.bindings == {"ID": 1, "ID_tool": 0}
    failing = [each for each in miss.conditions if not each.holds]
    assert [each.predicate for each in failing] == ["max_dimension(Dim, [0.05, 0.05, 1.0])"]
    assert failing[0].margin == pytest.approx(-0.004)
    assert failing[0].unit == "m"
    assert len(miss.conditions) == 7


def test_a_missing_affordance_is_explained_by_its_own_rule(reasoner: Reasoner) -> None:
    response = decide(reasoner, "cooking", "v2", PAN_WITH_FAT_HANDLE)
    assert response.reason is not None
    assert response.reason.code == "object_lacks_affordance"
    assert "grasp" in response.reason.message
    assert miss_of(response).rule == "thesis/version2:grasp"
    assert miss_of(response).bindings == {"ID": 1}


def test_no_primitives_is_an_answer(reasoner: Reasoner) -> None:
    for version in VERSIONS:
        response = decide(reasoner, "pouring", version, ())
        assert not response.found
        assert response.reason is not None
        assert response.reason.code == "no_primitives"


def test_an_unknown_task_lists_the_known_ones(reasoner: Reasoner) -> None:
    for version in VERSIONS:
        with pytest.raises(UnknownTask, match="dancing") as caught:
            decide(reasoner, "dancing", version, PAN)
        assert caught.value.details["known"] == list(TASKS)
        assert all(task in caught.value.message for task in TASKS)


@pytest.mark.parametrize("name", [" Pouring", "POURING\n", "pouring"])
def test_case_and_surrounding_space_of_a_task_do_not_matter(reasoner: Reasoner, name: str) -> None:
    assert decide(reasoner, name, "v2", BOTTLE) == decide(reasoner, "pouring", "v2", BOTTLE)


@pytest.mark.parametrize(
    "name",
    [
        "pouring), halt, x(",
        "'), halt.",
        "_",
        "X",
        "halt",
        ":- initialization(halt).",
        "pouring','Task') ; true",
        "{}",
        '"}, "operation": "forget_all',
        "\\x0\\",
        "\0",
        "日本語",
        "pouring\0",
        "wrap_grasp",
        "[]",
        "$stream",
        "p" * 64,
    ],
)
def test_a_task_name_is_data(reasoner: Reasoner, name: str) -> None:
    for version in VERSIONS:
        with pytest.raises(UnknownTask):
            decide(reasoner, name, version, PAN)
        assert decide(reasoner, "cooking", version, PAN).found


def test_bad_primitives_leave_nothing_behind(reasoner: Reasoner) -> None:
    with pytest.raises(InvalidInput):
        decide(reasoner, "cooking", "v2", (PAN[0], PAN[0]))
    assert decide(reasoner, "cooking", "v2", BOTTLE).labels.keys() == {0, 1}


def test_a_request_that_comes_to_no_end_is_given_up(settings: ReasoningSettings) -> None:
    hasty = Reasoner(settings.model_copy(update={"max_inferences": 100}))
    try:
        with pytest.raises(DeadlineExceeded, match="100 inferences"):
            decide(hasty, "cooking", "v1", PAN)
    finally:
        hasty.close()


def test_the_most_primitives_allowed_are_decided_in_time(
    reasoner: Reasoner, settings: ReasoningSettings
) -> None:
    many = tuple(
        part(number, (0.06 + 0.001 * number, 0.1, 0.2)) for number in range(settings.max_primitives)
    )
    for version, task in itertools.product(VERSIONS, TASKS):
        decide(reasoner, task, version, many)


def test_explain_false_leaves_only_the_explanation_out(reasoner: Reasoner) -> None:
    for version, task in itertools.product(VERSIONS, TASKS):
        told = decide(reasoner, task, version, PAN)
        brief = reasoner.decide(
            DecideRequest(
                task=task, reasoning=version, primitives=PAN, explain=False, rule_set="thesis"
            )
        )
        assert brief == told.model_copy(update={"explanation": None})


def test_all_reason_codes_are_documented() -> None:
    listed = (PROJECT_ROOT / "docs" / "reasons.md").read_text()
    assert all(f"`{code}`" in listed for code in CODES)


@few_examples
@given(primitives=objects, task=st.sampled_from(TASKS), version=st.sampled_from(VERSIONS))
def test_same_request_same_bytes(
    reasoner: Reasoner, primitives: tuple[Primitive, ...], task: str, version: Version
) -> None:
    first = decide(reasoner, task, version, primitives).model_dump_json()
    assert decide(reasoner, task, version, primitives).model_dump_json() == first


@few_examples
@given(primitives=objects, task=st.sampled_from(TASKS), version=st.sampled_from(VERSIONS))
def test_answers_are_consistent(
    reasoner: Reasoner, primitives: tuple[Primitive, ...], task: str, version: Version
) -> None:
    response = decide(reasoner, task, version, primitives)
    explanation = response.explanation
    assert explanation is not None
    assert explanation.text
    assert response.found == (response.region is not None) == (response.reason is None)
    assert response.found == bool(explanation.rules)
    regions = [response.region, *response.alternatives] if response.region else []
    confidences = [region.confidence for region in regions]
    assert confidences == sorted(confidences, reverse=True)
    held = [number for region in regions for number in region.primitive_ids]
    assert len(held) == len(set(held))
    if not response.found:
        assert response.reason is not None
        assert response.reason.code in CODES
        assert (explanation.nearest_miss is None) == (not primitives)
    for trace in explanation.rules:
        assert trace.holds
        assert all(condition.holds for condition in trace.conditions)
    for trace in [explanation.nearest_miss] if explanation.nearest_miss else []:
        assert not trace.holds
        assert not all(condition.holds for condition in trace.conditions)
        for condition in trace.conditions:
            assert condition.margin is None or condition.holds == (condition.margin >= 0)


@few_examples
@given(
    primitives=objects,
    task=st.sampled_from(TASKS),
    version=st.sampled_from(VERSIONS),
    data=st.data(),
)
def test_neither_pose_nor_axis_order_nor_numbering_matter(
    reasoner: Reasoner,
    primitives: tuple[Primitive, ...],
    task: str,
    version: Version,
    data: st.DataObject,
) -> None:
    numbers = data.draw(st.permutations(range(10, 10 + len(primitives))))
    axes = data.draw(st.permutations([0, 1, 2]))
    moved = tuple(
        part(
            number,
            tuple(each.full_extents[axis] for axis in axes),  # type: ignore[arg-type]
            each.shape_class,
            each.shape_probability,
            position=(0.3, -0.2, 1.1),
            quaternion=(0.5, 0.5, 0.5, 0.5),
        )
        for number, each in zip(numbers, primitives, strict=True)
    )
    before = decide(reasoner, task, version, primitives)
    after = decide(reasoner, task, version, moved)
    assert before.found == after.found
    assert {numbers[key]: labels for key, labels in before.labels.items()} == after.labels
    if before.region is not None and after.region is not None:
        regions = [before.region, *before.alternatives]
        new_numbers = {tuple(sorted(numbers[i] for i in r.primitive_ids)) for r in regions}
        others = [after.region, *after.alternatives]
        assert new_numbers == {tuple(sorted(r.primitive_ids)) for r in others}
        assert before.region.confidence == pytest.approx(after.region.confidence, abs=1e-6)
    elif before.explanation is not None and after.explanation is not None:
        assert before.reason == after.reason
