"""The questions that the ontology is made to answer: ontology/questions/*.rq."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from rdflib import RDF, Graph, Namespace

from services.reasoning.definition import listed
from services.reasoning.ontology import SPARGE
from shared.errors import InternalError, InvalidInput, NotFound
from shared.schemas.knowledge import AskQuestion, Question

OBJECTS = Namespace("https://example.org/sparge/objects#")
_PARAMETERS = "# parameters:"
_KNOWN_PARAMETERS = {"task", "affordance", "parts"}
_MAX_PARTS = 64


class Questions:
    """The questions in a folder, each with its query.

    A file begins with the question as a comment of one line, then a comment
    with its parameters. The query finds a task or an affordance that was given as
    `?asked`, and the parts of the object as `this:object :hasPart ?part`.

    Parameters
    ----------
    folder : Path

    Raises
    ------
    InternalError
        A file does not begin like that.
    """

    def __init__(self, folder: Path) -> None:
        self._queries = {file.stem: file.read_text("utf-8") for file in folder.glob("*.rq")}
        self.all = tuple(_described(name, text) for name, text in sorted(self._queries.items()))

    def find(self, name: str) -> tuple[Question, str]:
        """Return a question and its query.

        Raises
        ------
        NotFound
            There is no such question.
        """
        for question in self.all:
            if question.name == name:
                return question, self._queries[name]
        known = [question.name for question in self.all]
        raise NotFound(f"there is no question {name!r}; there are {listed(known)}", known=known)


def bindings_of(
    question: Question, asked: AskQuestion, tasks: Collection[str], affordances: Collection[str]
) -> dict[str, str]:
    """Return the IRIs of the query's variables.

    Raises
    ------
    InvalidInput
        A parameter is missing, is not one of this question, or names what is
        not known.
    """
    given = {name for name in _KNOWN_PARAMETERS if getattr(asked, name) is not None}
    if given != set(question.parameters):
        raise InvalidInput(
            f"the question {question.name!r} takes {listed(question.parameters)}; "
            f"found {listed(sorted(given))}",
            found=sorted(given),
            allowed=list(question.parameters),
        )
    for kind, name, known in (
        ("task", asked.task, tasks),
        ("affordance", asked.affordance, affordances),
    ):
        if name is not None:
            if name not in known:
                raise InvalidInput(
                    f"{kind}: there is no {kind} {name!r}; known are {listed(sorted(known))}",
                    field=kind,
                    found=name,
                )
            return {"asked": str(SPARGE[name])}
    return {}


def object_with(parts: str | None, affordances: Collection[str]) -> Graph:
    """Return statements about an object whose parts afford this; see `AskQuestion.parts`.

    Raises
    ------
    InvalidInput
        An affordance that is not known, or too many parts.
    """
    graph = Graph()
    if parts is None:
        return graph
    graph.add((OBJECTS.object, RDF.type, SPARGE.Object))
    pieces = parts.split(";")
    if len(pieces) > _MAX_PARTS:
        raise InvalidInput(f"parts: {_MAX_PARTS} are allowed, found {len(pieces)}", field="parts")
    for number, piece in enumerate(pieces):
        part = OBJECTS[f"part_{number}"]
        graph.add((OBJECTS.object, SPARGE.hasPart, part))
        graph.add((part, RDF.type, SPARGE.Part))
        for affordance in filter(None, piece.split(",")):
            if affordance not in affordances:
                raise InvalidInput(
                    f"parts: there is no affordance {affordance!r}; "
                    f"known are {listed(sorted(affordances))}",
                    field="parts",
                    found=affordance,
                )
            graph.add((part, SPARGE.affords, SPARGE[affordance]))
    return graph


def _described(name: str, text: str) -> Question:
    lines = text.splitlines()
    if len(lines) < 2 or not lines[0].startswith("# ") or not lines[1].startswith(_PARAMETERS):
        raise InternalError(f"the question {name!r} does not begin with itself and its parameters")
    parameters = lines[1].removeprefix(_PARAMETERS).replace(",", " ").split()
    if unknown := sorted(set(parameters) - _KNOWN_PARAMETERS):
        raise InternalError(f"the question {name!r} has unknown parameters: {listed(unknown)}")
    return Question(name=name, question=lines[0][2:], parameters=tuple(parameters))
