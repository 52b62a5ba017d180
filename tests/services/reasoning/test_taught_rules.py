"""Rules and affordances that are taught: proved like those of a file, refused when they are bad."""

from __future__ import annotations

import json
from typing import Any

import pytest
from pydantic import ValidationError

from services.reasoning.reasoner import Reasoner
from services.reasoning.settings import ReasoningSettings
from shared.errors import Conflict, InvalidInput, NotFound, SpargeError, UnknownTask
from shared.schemas.primitive import Primitive
from shared.schemas.route import Nothing
from shared.schemas.rule import (
    AffordanceDefinition,
    AffordanceName,
    RuleDefinition,
    RuleName,
)
from shared.schemas.task import DecideRequest, DecideResponse, RuleSet, TaskDefinition, TaskName
from tests.services.reasoning.objects import HAMMER, KNIFE, PAN, part

SLICING: dict[str, Any] = {
    "name": "slicing_by_handle",
    "task": "slicing",
    "part": "handle",
    "conditions": [
        {"condition": "min_dimension", "of": ["handle"], "value": [0.005, 0.01, 0.05]},
        {"condition": "max_dimension", "of": ["handle"], "value": [0.05, 0.1, 1]},
        {"condition": "shape", "of": ["handle"], "value": ["cylinder", "cuboid"]},
        {"condition": "min_ratio", "of": ["blade"], "value": 12},
        {"condition": "different", "of": ["handle", "blade"]},
    ],
}
STUBBY: dict[str, Any] = {"name": "stubby", "conditions": [{"condition": "max_ratio", "value": 3}]}


def rule(**fields: Any) -> RuleDefinition:
    return RuleDefinition.model_validate({**SLICING, **fields})


def condition(word: str, value: object = None, *of: str) -> dict[str, object]:
    return {"condition": word, "value": value, "of": list(of or ("handle",))}


def affordance(name: str = "press", *conditions: dict[str, Any]) -> AffordanceDefinition:
    rules = [{**STUBBY, "name": f"{name}_rule", "conditions": conditions or STUBBY["conditions"]}]
    return AffordanceDefinition.model_validate({"name": name, "description": "", "rules": rules})


def decide(
    reasoner: Reasoner,
    task: str,
    primitives: tuple[Primitive, ...] = KNIFE,
    reasoning: str = "v1",
    rule_set: RuleSet = "thesis",
) -> DecideResponse:
    return reasoner.decide(
        DecideRequest.model_validate(
            {
                "task": task,
                "reasoning": reasoning,
                "primitives": primitives,
                "rule_set": rule_set,
            }
        )
    )


@pytest.mark.parametrize("rule_set", ["thesis", "default"])
def test_a_version_1_task_is_taught_by_a_rule(reasoner: Reasoner, rule_set: RuleSet) -> None:
    with pytest.raises(UnknownTask):
        decide(reasoner, "slicing", rule_set=rule_set)
    reasoner.add_rule(rule())
    response = decide(reasoner, "slicing", rule_set=rule_set)
    assert response.region is not None
    assert response.region.primitive_ids == (1,)
    assert response.explanation is not None
    (trace,) = response.explanation.rules
    assert trace.rule == "learned/slicing_by_handle/version1:slicing"
    assert trace.bindings == {"handle": 1, "blade": 0}
    assert [each.predicate for each in trace.conditions] == [
        "min_dimension(Dim_handle, [0.005, 0.01, 0.05])",
        "max_dimension(Dim_handle, [0.05, 0.1, 1.0])",
        "Shape_handle == cuboid ; Shape_handle == cylinder",
        "min_ratio(Dim_blade, 12.0)",
        "ID_handle \\= ID_blade",
    ]
    assert "is at most 50 x 100 x 1000 mm" in response.explanation.text


def test_the_nearest_miss_of_a_taught_rule_says_by_how_much(reasoner: Reasoner) -> None:
    reasoner.add_rule(rule())
    blunt = (part(0, (0.002, 0.01, 0.02), "cuboid"), KNIFE[1])
    response = decide(reasoner, "slicing", blunt)
    assert not response.found
    assert response.explanation is not None
    assert response.explanation.nearest_miss is not None
    failing = [each for each in response.explanation.nearest_miss.conditions if not each.holds]
    assert [each.predicate for each in failing] == ["min_ratio(Dim_blade, 12.0)"]
    assert failing[0].margin == pytest.approx(-2)
    assert "part 0 were at least 12 times as long as thick" in response.explanation.text


def test_a_rule_can_add_to_a_shipped_task_and_be_taken_back(reasoner: Reasoner) -> None:
    before = decide(reasoner, "hammering", PAN)
    assert not before.found
    reasoner.add_rule(rule(task="hammering", conditions=[condition("largest")]))
    assert decide(reasoner, "hammering", PAN).found
    assert decide(reasoner, "hammering", HAMMER).found
    reasoner.delete_rule(RuleName(name="slicing_by_handle"))
    assert decide(reasoner, "hammering", PAN) == before


def test_several_rules_for_a_task_are_alternatives(reasoner: Reasoner) -> None:
    reasoner.add_rule(rule(name="small", conditions=[condition("smallest")]))
    reasoner.add_rule(rule(name="large", conditions=[condition("largest")]))
    response = decide(reasoner, "slicing", PAN)
    assert response.region is not None
    regions = (response.region, *response.alternatives)
    assert {each.primitive_ids for each in regions} == {(0,), (1,)}


def test_both_versions_can_learn_a_task_of_one_name(reasoner: Reasoner) -> None:
    task = TaskDefinition(name="slicing", requires=("cut",), grasp=("grasp",), avoids=("cut",))
    reasoner.add_rule(rule())
    assert reasoner.add_task(task).reasoning == ("v1", "v2")
    assert decide(reasoner, "slicing", reasoning="v2").found
    with pytest.raises(Conflict, match="a task 'slicing' already"):
        reasoner.add_task(task)
    assert reasoner.delete_task(TaskName(name="slicing")).reasoning == ("v1", "v2")
    assert decide(reasoner, "slicing").found
    with pytest.raises(Conflict, match="slicing_by_handle"):
        reasoner.delete_task(TaskName(name="slicing"))
    with pytest.raises(UnknownTask, match="no relations for 'slicing'"):
        decide(reasoner, "slicing", reasoning="v2")
    reasoner.delete_rule(RuleName(name="slicing_by_handle"))
    assert "slicing" not in {each.name for each in reasoner.list_tasks(Nothing()).tasks}


def test_an_affordance_is_added_with_its_rules(reasoner: Reasoner) -> None:
    reasoner.add_affordance(affordance())
    reasoner.add_task(TaskDefinition(name="pressing", requires=("press",), avoids=("press",)))
    response = decide(reasoner, "pressing", PAN, "v2")
    assert response.labels[0] == ("contain", "pound", "press", "wrap_grasp")
    assert response.region is not None
    assert response.region.primitive_ids == (1,)
    assert response.explanation is not None
    names = [trace.rule for trace in response.explanation.rules]
    assert "learned/press_rule/version2:press" in names
    listed = [each.name for each in reasoner.list_affordances(Nothing()).affordances]
    assert listed == sorted(listed)
    assert "press" in listed


def test_an_affordance_that_is_needed_stays(reasoner: Reasoner) -> None:
    reasoner.add_affordance(affordance())
    reasoner.add_task(TaskDefinition(name="pressing", grasp=("press",)))
    with pytest.raises(Conflict, match="'pressing' asks for the affordance 'press'"):
        reasoner.delete_affordance(AffordanceName(name="press"))
    with pytest.raises(Conflict, match="'press' would be left without a rule"):
        reasoner.delete_rule(RuleName(name="press_rule"))
    reasoner.delete_task(TaskName(name="pressing"))
    reasoner.add_rule(rule(conditions=[condition("affords", "press")]))
    with pytest.raises(Conflict, match="'slicing_by_handle' asks for the affordance 'press'"):
        reasoner.delete_affordance(AffordanceName(name="press"))
    reasoner.delete_rule(RuleName(name="slicing_by_handle"))
    reasoner.delete_affordance(AffordanceName(name="press"))
    assert reasoner.list_rules(Nothing()).rules == ()
    with pytest.raises(NotFound):
        reasoner.delete_affordance(AffordanceName(name="press"))
    with pytest.raises(Conflict, match="shipped"):
        reasoner.delete_affordance(AffordanceName(name="grasp"))


@pytest.mark.parametrize("rule_set", ["thesis", "default"])
def test_a_rule_can_build_on_affordances(reasoner: Reasoner, rule_set: RuleSet) -> None:
    reasoner.add_affordance(affordance("press", condition("max_ratio", 3, "part")))
    reasoner.add_rule(
        rule(conditions=[condition("affords_not", "press"), condition("affords", "press", "blade")])
    )
    response = decide(reasoner, "slicing", PAN, rule_set=rule_set)
    assert response.region is not None
    assert response.region.primitive_ids == (1,)


def test_affordances_cannot_ask_for_each_other_in_a_circle(reasoner: Reasoner) -> None:
    reasoner.add_affordance(affordance("press"))
    reasoner.add_affordance(affordance("push", condition("affords", "press", "part")))
    back = [condition("affords_not", "push")]
    with pytest.raises(Conflict, match="press -> push -> press"):
        reasoner.add_rule(rule(name="round", task=None, affordance="press", conditions=back))
    with pytest.raises(Conflict, match="roll -> roll"):
        reasoner.add_affordance(affordance("roll", condition("affords", "roll", "part")))
    assert decide(reasoner, "cooking", PAN, "v2").found


@pytest.mark.parametrize(
    ("field", "conditions"),
    [
        ("conditions.0.condition", [condition("halt")]),
        ("conditions.0.condition", [condition("assertz", "cut")]),
        ("conditions.0.value", [condition("min_ratio")]),
        ("conditions.0.value", [condition("min_ratio", "cut")]),
        ("conditions.0.value", [condition("min_ratio", [1, 2, 3])]),
        ("conditions.0.value", [condition("min_ratio", 0.5)]),
        ("conditions.0.value", [condition("min_dimension", 0.1)]),
        ("conditions.0.value", [condition("min_dimension", [-0.1, 0, 0])]),
        ("conditions.0.value", [condition("max_dimension", [0.1, 0.1, 1e6])]),
        ("conditions.0.value", [condition("shape", ["pyramid"])]),
        ("conditions.0.value", [condition("shape", [])]),
        ("conditions.0.value", [condition("shape", 3)]),
        ("conditions.0.value", [condition("largest", 1)]),
        ("conditions.0.value", [condition("affords", "juggle")]),
        ("conditions.0.value", [condition("affords", 1)]),
        ("conditions.0.of", [condition("different", None, "handle")]),
        ("conditions.0.of", [condition("largest", None, "handle", "blade")]),
        ("conditions", [condition("largest", None, name) for name in ("handle", *"abcd")]),
        ("part", [condition("largest", None, "blade")]),
        ("conditions.1.value", [condition("min_ratio", 3), condition("max_ratio", 2)]),
        ("conditions.1.value", [condition("max_holes", 0), condition("min_holes", 1)]),
        ("conditions.1.value", [condition("shape", "sphere"), condition("shape", "cuboid")]),
        ("conditions.0.of", [condition("different", None, "handle", "handle")]),
        (
            "conditions.1.value",
            [condition("min_dimension", [0, 0, 0.3]), condition("max_dimension", [1, 1, 0.2])],
        ),
        (  # dimensions are sorted: the width is at least the thickness
            "conditions.1.value",
            [condition("min_dimension", [0.1, 0, 0]), condition("max_dimension", [1, 0.05, 1])],
        ),
        ("conditions.1.value", [condition("max_width", 0.01), condition("min_thickness", 0.02)]),
        (
            "conditions.1.value",
            [condition("min_width", 0.05), condition("max_dimension", [1, 0.04, 1])],
        ),
        ("conditions.1.value", [condition("min_seen", 0.5), condition("max_seen", 0.4)]),
        (
            "conditions.2.value",
            [
                condition("min_length", 0.5),
                condition("max_thickness", 0.05),
                condition("max_ratio", 9),
            ],
        ),
        (
            "conditions.2.value",
            [
                condition("min_dimension", [0.05, 0, 0]),
                condition("max_dimension", [1, 1, 0.1]),
                condition("min_ratio", 12),
            ],
        ),
        (
            "conditions.2.value",
            [
                condition("min_dimension", [0, 0, 0.5]),
                condition("max_dimension", [0.05, 1, 1]),
                condition("max_ratio", 9),
            ],
        ),
    ],
)
def test_a_bad_rule_is_refused_naming_the_place(
    reasoner: Reasoner, field: str, conditions: list[dict[str, Any]]
) -> None:
    with pytest.raises(InvalidInput) as caught:
        reasoner.add_rule(rule(conditions=conditions))
    assert caught.value.details["field"] == field
    assert field in caught.value.message
    assert reasoner.list_rules(Nothing()).rules == ()
    with pytest.raises(UnknownTask):
        decide(reasoner, "slicing")


@pytest.mark.parametrize(
    "conditions",
    [
        [condition("min_dimension", [0.1, 0, 0]), condition("max_dimension", [0.1, 0.1, 0.1])],
        [condition("min_ratio", 2), condition("max_ratio", 2)],
        [condition("min_ratio", 3), condition("max_ratio", 2, "blade"), condition("largest")],
        [condition("shape", ["sphere", "cuboid"]), condition("shape", ["cuboid", "cylinder"])],
    ],
)
def test_bounds_that_can_be_met_are_taken(
    reasoner: Reasoner, conditions: list[dict[str, Any]]
) -> None:
    reasoner.add_rule(rule(conditions=conditions))
    assert len(reasoner.list_rules(Nothing()).rules) == 1


def test_names_have_one_meaning(reasoner: Reasoner) -> None:
    reasoner.add_rule(rule())
    reasoner.add_affordance(affordance())
    for wanted, said in (
        (rule(task="baking"), "a rule 'slicing_by_handle' already"),
        (rule(name="other", task="press"), "'press' is the name of an affordance"),
        (rule(name="other", task="grasp"), "'grasp' is the name of an affordance"),
    ):
        with pytest.raises(Conflict, match=said):
            reasoner.add_rule(wanted)
    for named, said in (
        ("press", "an? affordance 'press' already"),
        ("grasp", "an? affordance 'grasp' already"),
        ("slicing", "'slicing' is the name of a task"),
        ("cooking", "'cooking' is the name of a task"),
    ):
        with pytest.raises(Conflict, match=said):
            reasoner.add_affordance(affordance(named))
    with pytest.raises(InvalidInput, match="no affordance 'juggle'"):
        reasoner.add_rule(rule(name="other", task=None, affordance="juggle"))


def test_a_bad_rule_keeps_a_whole_affordance_out(reasoner: Reasoner) -> None:
    good, bad = STUBBY, {"name": "bad", "conditions": [condition("min_ratio", 2, "nobody")]}
    definition = {"name": "press", "rules": [good, bad]}
    with pytest.raises(InvalidInput, match="'bad' cannot be used: part: no condition"):
        reasoner.add_affordance(AffordanceDefinition.model_validate(definition))
    assert reasoner.list_rules(Nothing()).rules == ()
    assert "press" not in {each.name for each in reasoner.list_affordances(Nothing()).affordances}


def test_listed_rules_are_those_that_were_taught_with_their_prolog(reasoner: Reasoner) -> None:
    added = reasoner.add_rule(rule())
    listed = reasoner.list_rules(Nothing())
    assert listed.rules == (added,)
    same = added.model_dump(exclude={"prolog"})
    same["conditions"][2]["value"] = ["cylinder", "cuboid"]  # as sent; they are stored sorted
    assert RuleDefinition.model_validate(same) == rule()
    assert added.prolog.startswith("affordTask(ID_handle, slicing) :-\n    primitive_values(")
    words = {word.name: word for word in listed.vocabulary}
    assert {"min_dimension", "min_ratio", "shape", "largest", "affords", "different"} <= set(words)
    assert words["different"].parts == 2
    assert words["min_ratio"].low == 1
    assert all(word.says for word in words.values())


def test_every_word_can_be_used(reasoner: Reasoner) -> None:
    """Each is proved on an object, strictly and for the nearest miss, without an error."""
    for word in reasoner.list_rules(Nothing()).vocabulary:
        value: object = {
            "nothing": None,
            "number": word.low if word.direction == "min" else word.high,
            "lengths": [0.001, 0.001, 0.001],
            "shapes": ["cuboid"],
            "affordance": "cut",
        }[word.takes]
        of = ["handle", "blade"][: word.parts]
        name = f"with_{word.name}"
        reasoner.add_rule(
            rule(name=name, task=name, conditions=[{**condition(word.name, value), "of": of}])
        )
        response = decide(reasoner, name, rule_set="default")
        assert response.explanation is not None
        traces = response.explanation.rules or (response.explanation.nearest_miss,)
        assert traces[0] is not None
        assert traces[0].conditions


def test_a_taught_rule_survives_a_restart(reasoner: Reasoner, settings: ReasoningSettings) -> None:
    reasoner.add_rule(rule())
    reasoner.add_affordance(affordance())
    again = Reasoner(settings)
    try:
        assert again.list_rules(Nothing()) == reasoner.list_rules(Nothing())
        assert again.list_affordances(Nothing()) == reasoner.list_affordances(Nothing())
        assert decide(again, "slicing") == decide(reasoner, "slicing")
    finally:
        again.close()


def test_there_is_a_limit(settings: ReasoningSettings) -> None:
    small = Reasoner(settings.model_copy(update={"max_learned": 2}))
    try:
        small.add_rule(rule())
        small.add_rule(rule(name="second"))
        with pytest.raises(Conflict, match="SPARGE_REASONING_MAX_LEARNED"):
            small.add_rule(rule(name="third"))
    finally:
        small.close()


INJECTIONS = (
    "x), halt, y(",
    "'), halt.",
    ":- initialization(halt).",
    "halt",
    "Slicing",
    "_",
    "a b",
    "a\nb",
    "a\x00",
    "../../etc/passwd",
    "p' :- shell('id').",
    "é",
    "{}",
    "[]",
    '"}, "operation": "forget_all',
    "a" * 65,
    "$stream",
    "sparge:cut> . <x:y> a <x:z",
)


@pytest.mark.parametrize("text", INJECTIONS)
def test_nothing_that_is_sent_is_executed(reasoner: Reasoner, text: str) -> None:
    """Every field takes the text; it is refused or kept as data, and all goes on as before."""
    before = decide(reasoner, "cooking", PAN)
    known = reasoner.list_tasks(Nothing())
    rules: list[dict[str, Any]] = [
        {**SLICING, "name": text},
        {**SLICING, "task": text},
        {**SLICING, "task": None, "affordance": text},
        {**SLICING, "part": text},
        {**SLICING, "conditions": [condition(text)]},
        {**SLICING, "conditions": [condition("largest", None, text)]},
        {**SLICING, "conditions": [condition("min_ratio", text)]},
        {**SLICING, "conditions": [condition("shape", text)]},
        {**SLICING, "conditions": [condition("shape", [text, "cuboid"])]},
        {**SLICING, "conditions": [condition("affords", text)]},
        {**SLICING, text: 1},
    ]
    valid_names = {"halt"}
    for each in rules:
        try:
            reasoner.add_rule(RuleDefinition.model_validate_json(json.dumps(each)))
        except (ValidationError, SpargeError):
            continue
        assert text in valid_names
        reasoner.delete_rule(RuleName(name=each["name"]))
    described = reasoner.add_rule(rule(description=text))
    assert described.description == text
    added = AffordanceDefinition.model_validate(
        {"name": "press", "description": text, "rules": [{**STUBBY, "description": text}]}
    )
    assert reasoner.add_affordance(added).description == text
    assert decide(reasoner, "cooking", PAN) == before
    assert decide(reasoner, "slicing").found
    reasoner.delete_rule(RuleName(name="slicing_by_handle"))
    reasoner.delete_affordance(AffordanceName(name="press"))
    assert reasoner.list_tasks(Nothing()) == known
