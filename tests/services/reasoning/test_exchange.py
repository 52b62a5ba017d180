"""The knowledge as a Turtle document: out, in, and refused whole."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st
from rdflib import OWL, RDF, Graph, URIRef

from services.reasoning.ontology import SPARGE
from services.reasoning.reasoner import Reasoner
from services.reasoning.settings import ReasoningSettings
from shared.errors import Conflict, InvalidInput, SpargeError
from shared.schemas.knowledge import KnowledgeImport
from shared.schemas.route import Nothing
from shared.schemas.rule import AffordanceDefinition, RuleDefinition
from shared.schemas.task import DecideRequest, TaskDefinition
from tests.services.reasoning.objects import KNIFE
from tests.services.reasoning.test_taught_rules import SLICING, affordance, condition, rule

STIRRING = TaskDefinition(name="stirring", description='Round\nand "round".', grasp=("grasp",))


@pytest.fixture
def other(tmp_path: Path) -> ReasoningSettings:
    return ReasoningSettings(knowledge_dir=tmp_path / "other")


def everything(reasoner: Reasoner) -> tuple[object, ...]:
    return (
        reasoner.list_tasks(Nothing()),
        reasoner.list_affordances(Nothing()),
        reasoner.list_rules(Nothing()),
    )


def teach(reasoner: Reasoner) -> None:
    reasoner.add_affordance(affordance("press"))
    reasoner.add_task(STIRRING)
    reasoner.add_task(TaskDefinition(name="pressing", requires=("press",), avoids=("press", "cut")))
    reasoner.add_rule(rule(description="By its\thandle; 日本語."))
    reasoner.add_rule(
        rule(
            name="pressing_rule",
            task="pressing",
            conditions=[
                condition("affords", "press"),
                condition("affords_not", "grasp"),
                condition("shape", ["sphere"]),
                condition("max_relative_volume", 0.1234567890123, "handle", "blade"),
                condition("min_bottom", -1e-7),
            ],
        )
    )


def turtle(reasoner: Reasoner) -> str:
    return reasoner.export_knowledge(Nothing()).turtle


def test_what_is_exported_can_be_learned_elsewhere(
    reasoner: Reasoner, other: ReasoningSettings
) -> None:
    teach(reasoner)
    copy = Reasoner(other)
    try:
        imported = copy.import_knowledge(KnowledgeImport(turtle=turtle(reasoner)))
        assert imported.ignored == 0
        assert set(imported.tasks) == {"stirring", "pressing"}
        assert set(imported.affordances) == {"press"}
        assert set(imported.rules) == {"press_rule", "slicing_by_handle", "pressing_rule"}
        assert everything(copy) == everything(reasoner)
        request = DecideRequest(task="slicing", reasoning="v1", primitives=KNIFE)
        assert copy.decide(request) == reasoner.decide(request)
        again = Reasoner(other)
        assert everything(again) == everything(reasoner)
        again.close()
    finally:
        copy.close()


def test_a_document_that_is_known_changes_nothing(reasoner: Reasoner) -> None:
    teach(reasoner)
    before = everything(reasoner)
    for replace in (False, True):
        imported = reasoner.import_knowledge(
            KnowledgeImport(turtle=turtle(reasoner), replace=replace)
        )
        assert imported.ignored == 0
        assert bool(imported.tasks) == replace
        assert everything(reasoner) == before


def test_replacing_forgets_what_is_not_in_the_document(reasoner: Reasoner) -> None:
    teach(reasoner)
    document = turtle(reasoner)
    before = everything(reasoner)
    reasoner.add_task(TaskDefinition(name="waving", grasp=("press",)))
    reasoner.import_knowledge(KnowledgeImport(turtle=document, replace=True))
    assert everything(reasoner) == before
    reasoner.import_knowledge(KnowledgeImport(turtle="", replace=True))
    assert reasoner.list_rules(Nothing()).rules == ()
    assert all(task.builtin for task in reasoner.list_tasks(Nothing()).tasks)


def test_the_export_is_one_ontology_without_imports(reasoner: Reasoner) -> None:
    teach(reasoner)
    graph = Graph().parse(data=turtle(reasoner), format="turtle")
    assert len(list(graph.subjects(RDF.type, OWL.Ontology))) == 1
    assert not list(graph.objects(None, OWL.imports))
    typed = set(graph.subjects(RDF.type, None))
    ours = {
        term
        for statement in graph
        for term in statement
        if isinstance(term, URIRef) and term.startswith("https://example.org/sparge")
    }
    assert ours <= typed, "everything is declared, as Protege wants it"


PREFIXES = f"@prefix : <{SPARGE}> . @prefix rule: <https://example.org/sparge/rules#> . "


@pytest.mark.parametrize(
    ("text", "error", "said"),
    [
        ("nonsense", InvalidInput, "not Turtle"),
        ("[" * 5000, InvalidInput, "not Turtle"),
        (":flying a :Task .", InvalidInput, "grasp or avoids"),
        (":flying a :Task ; :hasGraspAffordance :wing .", InvalidInput, "wing"),
        (":Flying a :Task ; :hasGraspAffordance :grasp .", InvalidInput, "Flying"),
        ("<x:y> a :Task ; :hasGraspAffordance :grasp .", InvalidInput, "x:y"),
        ("<x:y> a :Affordance .", InvalidInput, "x:y"),
        (":grasp a :Task ; :hasGraspAffordance :grasp .", Conflict, "name of an affordance"),
        (":wing a :Affordance .", Conflict, "without a rule"),
        (":cooking a :Task ; :hasGraspAffordance :cut .", Conflict, "shipped"),
        (":grasp a :Affordance .", Conflict, "shipped"),
        ("rule:x a :Rule .", InvalidInput, "make no rule"),
        ("rule:x a :Rule ; :ruleForTask :y .", InvalidInput, "conditions"),
        (
            (
                "rule:x a :Rule ; :ruleForTask :y ; :heldPart 'p' ; :hasCondition rule:x.0 . "
                "rule:x.0 :word 'halt' ; :ofPart 'p' ."
            ),
            InvalidInput,
            "no 'halt'",
        ),
        (
            (
                "rule:x a :Rule ; :ruleForTask :y ; :heldPart 'p' ; :hasCondition rule:x.0 . "
                "rule:x.0 :word 'min_ratio' ; :ofPart 'p' ; :number 'many' ."
            ),
            InvalidInput,
            "rule",
        ),
        (
            (
                "rule:a a :Rule ; :ruleForAffordance :one ; :heldPart 'p' . "
                "rule:a :hasCondition rule:a.0 . "
                "rule:a.0 :word 'affords' ; :ofPart 'p' ; :asksForAffordance :two . "
                "rule:b a :Rule ; :ruleForAffordance :two ; :heldPart 'p' . "
                "rule:b :hasCondition rule:b.0 . "
                "rule:b.0 :word 'affords' ; :ofPart 'p' ; :asksForAffordance :one . "
                ":one a :Affordance . :two a :Affordance ."
            ),
            Conflict,
            "circle: one -> two -> one",
        ),
    ],
)
def test_a_bad_document_is_refused_whole(
    reasoner: Reasoner, text: str, error: type[SpargeError], said: str
) -> None:
    teach(reasoner)
    before = everything(reasoner)
    good = ":baking a :Task ; :hasGraspAffordance :grasp . "
    for replace in (False, True):
        with pytest.raises(error, match=said):
            reasoner.import_knowledge(
                KnowledgeImport(turtle=PREFIXES + good + text, replace=replace)
            )
        assert everything(reasoner) == before


def test_a_learned_name_is_not_taken_over_unless_it_replaces(reasoner: Reasoner) -> None:
    reasoner.add_task(STIRRING)
    document = PREFIXES + ":stirring a :Task ; :hasGraspAffordance :wrap_grasp ."
    with pytest.raises(Conflict, match="a task 'stirring' already"):
        reasoner.import_knowledge(KnowledgeImport(turtle=document))
    reasoner.import_knowledge(KnowledgeImport(turtle=document, replace=True))
    (known,) = [task for task in reasoner.list_tasks(Nothing()).tasks if not task.builtin]
    assert known.grasp == ("wrap_grasp",)


def test_statements_of_no_use_are_counted(reasoner: Reasoner) -> None:
    document = PREFIXES + (
        ":baking a :Task ; :hasGraspAffordance :grasp ; :madeBy 'me' . <x:y> <x:p> [ <x:q> 1 ] ."
        "<x:y> <http://www.w3.org/2002/07/owl#imports> <http://127.0.0.1:1/nothing-is-fetched> ."
    )
    assert reasoner.import_knowledge(KnowledgeImport(turtle=document)).ignored == 4


numbers = st.floats(min_value=0.001, max_value=1, allow_nan=False)
conditions = st.one_of(
    st.builds(lambda v: condition("min_ratio", v), st.floats(1, 1000)),
    st.builds(
        lambda v: condition("min_dimension", sorted(v)), st.tuples(numbers, numbers, numbers)
    ),
    st.builds(
        lambda v: condition("shape", sorted(v)),
        st.sets(st.sampled_from(["cuboid", "cylinder", "sphere"]), min_size=1),
    ),
    st.builds(lambda v: condition("affords", v), st.sampled_from(["cut", "grasp"])),
    st.just(condition("largest")),
)


@hypothesis_settings(
    max_examples=40,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(written=st.lists(conditions, min_size=1, max_size=12), text=st.text(max_size=60))
def test_any_rule_survives_the_way_through_turtle(
    reasoner: Reasoner, written: list[dict[str, object]], text: str
) -> None:
    definition = RuleDefinition.model_validate(
        {**SLICING, "conditions": written, "description": text}
    )
    try:
        reasoner.add_rule(definition)
    except InvalidInput:  # bounds that cannot be met together
        return
    document = turtle(reasoner)
    before = everything(reasoner)
    reasoner.import_knowledge(KnowledgeImport(turtle="", replace=True))
    reasoner.import_knowledge(KnowledgeImport(turtle=document))
    assert everything(reasoner) == before
    reasoner.import_knowledge(KnowledgeImport(turtle="", replace=True))


def test_affordances_are_described(reasoner: Reasoner, other: ReasoningSettings) -> None:
    definition = AffordanceDefinition.model_validate(
        {**affordance("press").model_dump(), "description": "Pressing <b> & co."}
    )
    reasoner.add_affordance(definition)
    assert "Pressing <b> & co." in turtle(reasoner)
