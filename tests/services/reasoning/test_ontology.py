"""The ontology as a document: it loads, agrees with the rules, and answers questions."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from rdflib import OWL, RDF, RDFS, Graph, URIRef

from services.reasoning.ontology import (
    SPARGE,
    add_task,
    affordances_in,
    load_ontology,
    read_turtle,
    tasks_in,
    triples_of,
)
from services.reasoning.settings import ReasoningSettings
from shared.errors import InternalError
from shared.settings import PROJECT_ROOT

RELATIONS = (SPARGE.requiresAffordance, SPARGE.hasGraspAffordance, SPARGE.avoidsAffordance)


@pytest.fixture(scope="module")
def graph() -> Graph:
    return load_ontology(ReasoningSettings().ontology_file)


def ask(graph: Graph, question: str) -> set[str]:
    prefixes = f"PREFIX : <{SPARGE}> PREFIX rdfs: <{RDFS}> "
    return {str(row[0]).removeprefix(str(SPARGE)) for row in graph.query(prefixes + question)}  # type: ignore[index]


def test_imports_resolve_and_make_no_circle() -> None:
    folder = ReasoningSettings().ontology_file.parent
    imports = {
        file.stem: {
            str(iri).rsplit("/", 1)[1] for iri in read_turtle(file).objects(None, OWL.imports)
        }
        for file in folder.glob("*.ttl")
    }
    assert imports["sparge"] == {"tasks", "affordances", "rules", "objects"}
    assert not any("soma_alignment" in targets for targets in imports.values())
    assert all(targets <= set(imports) for targets in imports.values())
    while imports:
        leaves = {name for name, targets in imports.items() if not targets}
        assert leaves, f"a circle among {sorted(imports)}"
        imports = {
            name: targets - leaves for name, targets in imports.items() if name not in leaves
        }


def test_every_affordance_used_is_declared(graph: Graph) -> None:
    used = {each for relation in RELATIONS for each in graph.objects(None, relation)}
    assert used <= set(graph.subjects(RDF.type, SPARGE.Affordance))


def test_relations_go_from_tasks_to_affordances(graph: Graph) -> None:
    for relation in RELATIONS:
        assert graph.value(relation, RDFS.domain) == SPARGE.Task
        assert graph.value(relation, RDFS.range) == SPARGE.Affordance
        assert set(graph.subjects(relation)) <= set(graph.subjects(RDF.type, SPARGE.Task))


def test_everything_is_labelled_and_described(graph: Graph) -> None:
    for subject in set(graph.subjects(RDF.type, None)):
        assert isinstance(subject, URIRef)
        assert graph.value(subject, RDFS.label), subject
        if (subject, RDF.type, OWL.Ontology) not in graph:
            assert graph.value(subject, RDFS.comment), subject


def test_names_of_tasks_and_affordances_differ(graph: Graph) -> None:
    assert not set(tasks_in(graph)) & set(affordances_in(graph))


def test_every_affordance_has_a_rule_and_every_rule_an_affordance(graph: Graph) -> None:
    rules = (PROJECT_ROOT / "rules" / "thesis" / "version2.pl").read_text()
    heads = re.findall(r"^partAffordance\(ID, (\w+)\) :-", rules, re.MULTILINE)
    assert sorted(heads) == list(affordances_in(graph))


def test_which_tasks_need_a_container(graph: Graph) -> None:
    assert ask(graph, "SELECT ?t { ?t a :Task ; :requiresAffordance :contain }") == {
        "cooking",
        "pouring",
    }


def test_what_must_an_object_for_turning_offer_and_where_is_it_held(graph: Graph) -> None:
    assert ask(graph, "SELECT ?a { :turning :requiresAffordance ?a }") == {"grasp", "support"}
    assert ask(graph, "SELECT ?a { :turning :hasGraspAffordance ?a }") == {"grasp"}


def test_which_tasks_leave_a_part_free(graph: Graph) -> None:
    assert ask(graph, "SELECT ?t { ?t :avoidsAffordance ?a }") == {"handover", "cutting"}


def test_every_task_says_what_to_hold(graph: Graph) -> None:
    question = """SELECT ?t { ?t a :Task
        FILTER NOT EXISTS { ?t :hasGraspAffordance ?a }
        FILTER NOT EXISTS { ?t :avoidsAffordance ?b } }"""
    assert ask(graph, question) == set()


def test_a_task_survives_the_way_through_turtle(graph: Graph) -> None:
    for task in tasks_in(graph).values():
        written = Graph()
        add_task(written, task)
        text = written.serialize(format="turtle")
        assert tasks_in(Graph().parse(data=text, format="turtle")) == {task.name: task}


def test_triples_are_local_names(graph: Graph) -> None:
    assert triples_of([tasks_in(graph)["handover"]]) == [
        ("handover", "type", "Task"),
        ("handover", "avoidsAffordance", "wrap_grasp"),
    ]


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("this is no turtle", "is not Turtle"),
        (
            "<a:b> <http://www.w3.org/2002/07/owl#imports> <https://example.com/x> .",
            "can be imported",
        ),
        (
            "<a:b> <http://www.w3.org/2002/07/owl#imports> <https://example.org/sparge/gone> .",
            "cannot be read",
        ),
        (
            "<a:b> <http://www.w3.org/2002/07/owl#imports> <https://example.org/sparge/../x> .",
            "can be imported",
        ),
    ],
)
def test_an_unusable_ontology_is_named(tmp_path: Path, text: str, complaint: str) -> None:
    file = tmp_path / "sparge.ttl"
    file.write_text(text)
    with pytest.raises(InternalError, match=complaint):
        load_ontology(file)
