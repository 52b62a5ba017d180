"""The OWL ontology: Turtle files <-> tasks, affordances and triples."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from pydantic import ValidationError
from rdflib import OWL, RDF, RDFS, Graph, Literal, Namespace, URIRef

from shared.errors import InternalError
from shared.schemas.task import Affordance, TaskDefinition

SPARGE = Namespace("https://example.org/sparge#")
_ONTOLOGIES = "https://example.org/sparge/"
_RELATIONS = {
    "requires": SPARGE.requiresAffordance,
    "grasp": SPARGE.hasGraspAffordance,
    "avoids": SPARGE.avoidsAffordance,
}

Triple = tuple[str, str, str]


def load_ontology(file: Path) -> Graph:
    """Return the statements of `file` and of all that it imports.

    An import `https://example.org/sparge/NAME` is the file `NAME.ttl` in the
    same folder; nothing is fetched.

    Raises
    ------
    InternalError
        A file is missing or is not Turtle; names the file.
    """
    graph = Graph()
    waiting, loaded = [file], set[Path]()
    while waiting:
        current = waiting.pop()
        if current in loaded:
            continue
        loaded.add(current)
        one = read_turtle(current)
        graph += one
        waiting += [_imported(file.parent, iri, current) for iri in one.objects(None, OWL.imports)]
    return graph


def read_turtle(file: Path) -> Graph:
    """Return the statements of one Turtle file.

    Raises
    ------
    InternalError
        It cannot be read, or is not Turtle.
    """
    try:
        return Graph().parse(data=file.read_text(encoding="utf-8"), format="turtle")
    except OSError as error:
        raise InternalError(f"the ontology file {file} cannot be read: {error.strerror}") from error
    except Exception as error:  # rdflib's parser has no common error class
        raise InternalError(f"{file} is not Turtle: {' '.join(str(error).split())}") from error


def _imported(folder: Path, iri: object, importer: Path) -> Path:
    name = str(iri).removeprefix(_ONTOLOGIES)
    if not str(iri).startswith(_ONTOLOGIES) or not name.isidentifier():
        raise InternalError(f"{importer} imports {iri}; only {_ONTOLOGIES}NAME can be imported")
    return folder / f"{name}.ttl"


def affordances_in(graph: Graph) -> dict[str, Affordance]:
    """Return the affordances by name, sorted.

    Raises
    ------
    InternalError
        An affordance whose name cannot be used; says which.
    """
    names = sorted(_local_name(each) for each in graph.subjects(RDF.type, SPARGE.Affordance))
    return {name: _affordance(graph, name) for name in names}


def _affordance(graph: Graph, name: str) -> Affordance:
    try:
        return Affordance(name=name, description=_comment(graph, SPARGE[name]))
    except ValidationError as error:
        raise InternalError(f"the ontology's affordance {name!r} is not usable: {error}") from error


def tasks_in(graph: Graph) -> dict[str, TaskDefinition]:
    """Return the tasks by name, sorted.

    Raises
    ------
    InternalError
        A task whose name or relations cannot be used; names the task.
    """
    names = sorted(_local_name(each) for each in graph.subjects(RDF.type, SPARGE.Task))
    return {name: _task(graph, name) for name in names}


def _task(graph: Graph, name: str) -> TaskDefinition:
    relations = {
        field: tuple(sorted(_local_name(each) for each in graph.objects(SPARGE[name], property_)))
        for field, property_ in _RELATIONS.items()
    }
    try:
        return TaskDefinition(name=name, description=_comment(graph, SPARGE[name]), **relations)
    except ValidationError as error:
        raise InternalError(f"the ontology's task {name!r} is not usable: {error}") from error


def add_task(graph: Graph, task: TaskDefinition) -> None:
    """Add the statements about one task, as in ontology/tasks.ttl."""
    _add_individual(graph, SPARGE.Task, task.name, task.description)
    for property_, affordance in _relations(task):
        graph.add((SPARGE[task.name], property_, SPARGE[affordance]))


def add_affordance(graph: Graph, affordance: Affordance) -> None:
    """Add the statements about one affordance, as in ontology/affordances.ttl."""
    _add_individual(graph, SPARGE.Affordance, affordance.name, affordance.description)


def _add_individual(graph: Graph, kind: URIRef, name: str, description: str) -> None:
    subject = SPARGE[name]
    graph.add((subject, RDF.type, OWL.NamedIndividual))
    graph.add((subject, RDF.type, kind))
    graph.add((subject, RDFS.label, Literal(name.replace("_", " "))))
    if description:
        graph.add((subject, RDFS.comment, Literal(description)))


def triples_of(tasks: Iterable[TaskDefinition]) -> list[Triple]:
    """Return what Prolog is told about the tasks: triples of local names."""
    return [
        triple
        for task in tasks
        for triple in (
            (task.name, "type", "Task"),
            *((task.name, _local_name(p), affordance) for p, affordance in _relations(task)),
        )
    ]


def _relations(task: TaskDefinition) -> list[tuple[URIRef, str]]:
    return [
        (property_, affordance)
        for field, property_ in _RELATIONS.items()
        for affordance in getattr(task, field)
    ]


def _local_name(node: object) -> str:
    return str(node).removeprefix(str(SPARGE))


def _comment(graph: Graph, subject: URIRef) -> str:
    comment = graph.value(subject, RDFS.comment)
    return "" if comment is None else str(comment)
