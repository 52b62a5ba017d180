"""Questions about the knowledge: free ones in SPARQL, and those of the ontology."""

from __future__ import annotations

from services.reasoning.archive import Archive
from services.reasoning.knowledge import Knowledge
from services.reasoning.questions import Questions, bindings_of, object_with
from services.reasoning.settings import ReasoningSettings
from services.reasoning.sparql import Sparql
from shared.schemas.knowledge import (
    AskQuestion,
    QuestionAnswer,
    QuestionList,
    SparqlAnswer,
    SparqlQuery,
)


class Enquiry:
    """Answers questions about what is known at that moment; changes nothing.

    Parameters
    ----------
    settings : ReasoningSettings
    knowledge : Knowledge
    archive : Archive
        The same, as a graph.
    """

    def __init__(self, settings: ReasoningSettings, knowledge: Knowledge, archive: Archive) -> None:
        self._knowledge = knowledge
        self._archive = archive
        self._questions = Questions(settings.ontology_file.parent / "questions")
        self._sparql = Sparql(settings.sparql_timeout_s, settings.max_rows)

    def close(self) -> None:
        """End the process that answers."""
        self._sparql.close()

    def query(self, asked: SparqlQuery) -> SparqlAnswer:
        """Answer a SPARQL query; see `Sparql.ask`."""
        return self._sparql.ask(asked.query, self._archive.version(), self._archive.graph)

    def questions(self) -> QuestionList:
        """Return the questions of the ontology."""
        return QuestionList(questions=self._questions.all)

    def ask(self, asked: AskQuestion) -> QuestionAnswer:
        """Answer one of them.

        Raises
        ------
        NotFound
            There is no such question.
        InvalidInput
            Its parameters are not those that it takes.
        """
        question, query = self._questions.find(asked.name)
        tasks = [task.name for task in self._knowledge.tasks()]
        affordances = [affordance.name for affordance in self._knowledge.affordances()]
        answer = self._sparql.ask(
            query,
            self._archive.version(),
            self._archive.graph,
            object_with(asked.parts, affordances),
            bindings_of(question, asked, tasks, affordances),
        )
        return QuestionAnswer(**dict(question), answer=answer, query=query)
