"""The knowledge as a whole: out as Turtle, in as Turtle, and asked in SPARQL."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from shared.schemas.fields import Name
from shared.schemas.route import Nothing, Route
from shared.wire import Message

MAX_TURTLE = 8 * 2**20
MAX_QUERY = 10_000


class KnowledgeDocument(Message):
    """Everything that is known: ontology, added tasks and affordances, taught rules."""

    turtle: str
    """One OWL ontology without imports."""


class KnowledgeImport(Message):
    """A document to learn from."""

    turtle: Annotated[str, Field(max_length=MAX_TURTLE)]
    replace: bool = False
    """Forget first what was learned before; otherwise the document adds to it."""


class KnowledgeImported(Message):
    """What was learned from a document."""

    tasks: tuple[Name, ...]
    affordances: tuple[Name, ...]
    rules: tuple[Name, ...]
    ignored: int
    """Statements that SPaRGE has no use for."""


class SparqlQuery(Message):
    """A question to the knowledge: SELECT or ASK."""

    query: Annotated[str, Field(min_length=1, max_length=MAX_QUERY)]


class SparqlTerm(Message):
    """A value, as in the W3C's SPARQL 1.1 Query Results JSON Format."""

    type: Literal["uri", "literal", "bnode"]
    value: str


class SparqlHead(Message):
    """Which variables an answer has."""

    vars: tuple[str, ...] = ()


class SparqlBindings(Message):
    """The rows of an answer; a variable without a value is left out."""

    bindings: tuple[dict[str, SparqlTerm], ...] = ()


class SparqlAnswer(Message):
    """Rows for SELECT, a boolean for ASK."""

    head: SparqlHead = SparqlHead()
    results: SparqlBindings | None = None
    boolean: bool | None = None
    truncated: bool = False
    """There were more rows than are returned."""


class Question(Message):
    """A question that the ontology is made to answer."""

    name: Name
    question: str
    parameters: tuple[Name, ...]
    """What it must be given."""


class QuestionList(Message):
    """The questions that can be asked."""

    questions: tuple[Question, ...]


class AskQuestion(Message):
    """A question with its parameters."""

    name: Name
    task: Name | None = None
    affordance: Name | None = None
    parts: Annotated[str, Field(max_length=2000, pattern=r"^[a-z0-9_,;]*$")] | None = None
    """What each part of the object affords: parts are separated by `;`, affordances by `,`,
    as in `contain,grasp;grasp`. An answer calls them part_0, part_1, ..."""


class QuestionAnswer(Question):
    """A question and its answer."""

    answer: SparqlAnswer
    query: str
    """In SPARQL, as it stands in ontology/questions."""


EXPORT_KNOWLEDGE = Route(
    "reasoning", "/knowledge", Nothing, KnowledgeDocument, "All that is known, as Turtle", "GET"
)
IMPORT_KNOWLEDGE = Route(
    "reasoning",
    "/knowledge",
    KnowledgeImport,
    KnowledgeImported,
    "Learn from a Turtle document",
    changes=True,
)
QUERY_KNOWLEDGE = Route(
    "reasoning", "/sparql", SparqlQuery, SparqlAnswer, "Ask the knowledge in SPARQL; read only"
)
LIST_QUESTIONS = Route(
    "reasoning",
    "/ontology/questions",
    Nothing,
    QuestionList,
    "The questions that the ontology answers",
    "GET",
)
ASK_QUESTION = Route(
    "reasoning",
    "/ontology/questions/{name}",
    AskQuestion,
    QuestionAnswer,
    "Ask one of these questions",
    "GET",
)
