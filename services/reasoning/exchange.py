"""The whole knowledge as one Turtle document, out and in."""

from __future__ import annotations

from dataclasses import dataclass

from rdflib import OWL, RDF, RDFS, BNode, Graph, Literal, URIRef
from rdflib.term import Node

from services.reasoning.change import Change, Learned
from services.reasoning.ontology import (
    SPARGE,
    add_affordance,
    add_task,
    affordances_in,
    tasks_in,
)
from services.reasoning.rule_statements import RULES, add_rule, rules_in
from services.reasoning.shipped import Shipped
from shared.errors import Conflict, InternalError, InvalidInput
from shared.schemas.task import Affordance

_DOCUMENT = URIRef("https://example.org/sparge/knowledge")


@dataclass(frozen=True)
class Document:
    """What a document holds beside the shipped knowledge.

    Attributes
    ----------
    change : Change
        Its tasks, affordances and rules that are not shipped.
    ignored : int
        Statements that SPaRGE has no use for.
    """

    change: Change
    ignored: int


def graph_of(shipped: Shipped, learned: Learned, affordance_words: frozenset[str]) -> Graph:
    """Return shipped and learned knowledge as one ontology without imports."""
    graph = _shipped_statements(shipped)
    graph.add((_DOCUMENT, RDF.type, OWL.Ontology))
    graph.add((_DOCUMENT, RDFS.label, Literal("SPaRGE knowledge")))
    for name in learned.tasks_with_rules() - set(shipped.tasks) - set(learned.tasks):
        graph.add((SPARGE[name], RDF.type, OWL.NamedIndividual))
        graph.add((SPARGE[name], RDF.type, SPARGE.Task))
    for affordance in learned.affordances.values():
        add_affordance(graph, affordance)
    for task in learned.tasks.values():
        add_task(graph, task)
    for rule in learned.rules.values():
        add_rule(graph, rule, affordance_words)
    return graph


def read_document(turtle: str, shipped: Shipped, affordance_words: frozenset[str]) -> Document:
    """Return what a Turtle document holds; imports are not followed.

    Raises
    ------
    InvalidInput
        It is not Turtle, or a name or a rule in it cannot be used.
    Conflict
        It says something else about shipped knowledge than what is shipped.
    """
    try:
        graph = Graph().parse(data=turtle, format="turtle")
    except Exception as error:  # rdflib's parser has no common error class
        reason = " ".join(str(error).split())[:300]
        raise InvalidInput(f"turtle: not Turtle: {reason}", field="turtle") from None
    change = _change_in(graph, shipped)
    known = graph_of(shipped, Learned().after(change), affordance_words)
    of_lists = {each[1] for each in shipped.graph if _is_nameless(each)}
    ignored = [
        each
        for each in graph
        if (each[1] not in of_lists if _is_nameless(each) else each not in known)
    ]
    return Document(change, len(ignored))


def _change_in(graph: Graph, shipped: Shipped) -> Change:
    try:
        tasks, affordances = tasks_in(graph), affordances_in(graph)
    except InternalError as error:
        raise InvalidInput(error.message, field="turtle") from None
    rules = rules_in(graph)
    by_rule_alone = {rule.task for rule in rules.values()}
    new_tasks = []
    for name, task in tasks.items():
        if name in shipped.tasks:
            _same("task", name, task == shipped.tasks[name])
        elif task.grasp or task.avoids or task.requires or name not in by_rule_alone:
            new_tasks.append(task)
    new_affordances: list[Affordance] = []
    for name, affordance in affordances.items():
        if name in shipped.affordances:
            _same("affordance", name, affordance == shipped.affordances[name])
        else:
            new_affordances.append(affordance)
    return Change(
        tasks=tuple(new_tasks), affordances=tuple(new_affordances), rules=tuple(rules.values())
    )


def _is_nameless(statement: tuple[Node, ...]) -> bool:
    """Say whether a statement has a blank node, which has another name in every document."""
    return any(isinstance(term, BNode) for term in statement)


def _same(kind: str, name: str, same: bool) -> None:
    if not same:
        raise Conflict(
            f"the document's {kind} {name!r} is not the shipped one, which cannot be changed",
            found=name,
        )


def _shipped_statements(shipped: Shipped) -> Graph:
    graph = Graph()
    graph.bind("", SPARGE)
    graph.bind("rule", RULES)
    headers = set(shipped.graph.subjects(RDF.type, OWL.Ontology))
    for statement in shipped.graph:
        if statement[0] not in headers:
            graph.add(statement)
    return graph
