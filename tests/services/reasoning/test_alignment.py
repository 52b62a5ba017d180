"""OWL 2 RL reasoning over the ontology: it is consistent, and aligned with SOMA and DUL."""

from __future__ import annotations

import owlrl
import pytest
from rdflib import OWL, RDF, Graph, Namespace

from services.reasoning.ontology import SPARGE, load_ontology
from services.reasoning.reasoner import Reasoner
from services.reasoning.settings import ReasoningSettings
from shared.schemas.route import Nothing
from tests.services.reasoning.test_exchange import teach

SOMA = Namespace("http://www.ease-crc.org/ont/SOMA.owl#")
DUL = Namespace("http://www.ontologydesignpatterns.org/ont/dul/DUL.owl#")
ERROR = Namespace("http://www.daml.org/2002/03/agents/agent-ont#").ErrorMessage
PREFIX = f"@prefix : <{SPARGE}> . @prefix owl: <{OWL}> . "


def reasoned(*more: str) -> Graph:
    """Return the ontology with the alignment and all that follows."""
    settings = ReasoningSettings()
    graph = load_ontology(settings.ontology_file)
    graph += load_ontology(settings.ontology_file.parent / "soma_alignment.ttl")
    for text in more:
        graph.parse(data=PREFIX + text, format="turtle")
    owlrl.DeductiveClosure(owlrl.OWLRL_Semantics).expand(graph)
    return graph


def contradictions(graph: Graph) -> list[str]:
    errors = [str(graph.value(each, None)) for each in graph.subjects(RDF.type, ERROR)]
    return errors + [str(each) for each in graph.subjects(RDF.type, OWL.Nothing)]


@pytest.fixture(scope="module")
def graph() -> Graph:
    return reasoned()


def test_it_is_consistent(graph: Graph) -> None:
    assert contradictions(graph) == []


@pytest.mark.parametrize(
    "text",
    [
        ":pouring a :Affordance .",
        ":grasp :requiresAffordance :contain .",
        ":pouring :requiresAffordance :cooking .",
        ":blade a :Part ; :affords :pouring .",
        ":pouring a :Rule .",
    ],
)
def test_a_contradiction_is_found(text: str) -> None:
    assert contradictions(reasoned(text)) != []


def test_tasks_are_tasks_of_dul(graph: Graph) -> None:
    for task in graph.subjects(RDF.type, SPARGE.Task):
        assert (task, RDF.type, SOMA.PhysicalTask) in graph
        assert (task, RDF.type, DUL.Task) in graph


def test_tasks_that_soma_names(graph: Graph) -> None:
    assert (SPARGE.pouring, RDF.type, SOMA.Pouring) in graph
    assert (SPARGE.cutting, RDF.type, SOMA.Cutting) in graph
    assert (SPARGE.turning, RDF.type, SOMA.Flipping) in graph
    assert (SPARGE.pouring, RDF.type, SOMA.Cutting) not in graph


def test_what_soma_calls_cutting_is_a_task_of_ours() -> None:
    graph = reasoned(":slicing a <http://www.ease-crc.org/ont/SOMA.owl#Cutting> .")
    assert (SPARGE.slicing, RDF.type, SPARGE.Task) in graph


def test_affordances_define_the_tasks_that_ask_for_them(graph: Graph) -> None:
    assert (SPARGE.contain, SOMA.affordanceDefinesTask, SPARGE.pouring) in graph
    assert (SPARGE.wrap_grasp, SOMA.affordanceDefinesTask, SPARGE.handover) in graph
    assert (SPARGE.pound, SOMA.affordanceDefinesTask, SPARGE.pouring) not in graph
    for affordance in graph.subjects(RDF.type, SPARGE.Affordance):
        assert (affordance, RDF.type, DUL.Description) in graph


def test_an_object_offers_what_its_parts_afford() -> None:
    graph = reasoned(":mug :hasPart :body, :ear . :body :affords :contain .")
    assert (SPARGE.mug, SPARGE.offers, SPARGE.contain) in graph
    assert (SPARGE.mug, SPARGE.offers, SPARGE.grasp) not in graph
    assert (SPARGE.mug, RDF.type, DUL.PhysicalObject) in graph
    assert (SPARGE.body, DUL.isDescribedBy, SPARGE.contain) in graph


def test_what_is_taught_stays_consistent(reasoner: Reasoner) -> None:
    teach(reasoner)
    text = reasoner.export_knowledge(Nothing()).turtle
    graph = reasoned(text)
    assert contradictions(graph) == []
    assert (SPARGE.stirring, RDF.type, DUL.Task) in graph


def test_nothing_of_theirs_is_imported() -> None:
    folder = ReasoningSettings().ontology_file.parent
    for file in folder.glob("*.ttl"):
        imports = Graph().parse(file).objects(None, OWL.imports)
        assert all(str(each).startswith("https://example.org/sparge/") for each in imports)


def test_the_document_that_is_exported_has_the_shipped_statements(reasoner: Reasoner) -> None:
    settings = ReasoningSettings()
    shipped = load_ontology(settings.ontology_file)
    headers = set(shipped.subjects(RDF.type, OWL.Ontology))
    exported = Graph().parse(data=reasoner.export_knowledge(Nothing()).turtle, format="turtle")
    assert len(exported) == sum(statement[0] not in headers for statement in shipped) + 2
