"""All that is known as one document, out and in."""

from __future__ import annotations

from rdflib import Graph

from services.reasoning.change import Change, Learned
from services.reasoning.exchange import graph_of, read_document
from services.reasoning.memory import Memory
from services.reasoning.shipped import Shipped
from shared.schemas.knowledge import KnowledgeDocument, KnowledgeImport, KnowledgeImported
from shared.schemas.rule import Word


class Archive:
    """The knowledge as an ontology.

    Parameters
    ----------
    memory : Memory
        What was learned.
    shipped : Shipped
    words : tuple of Word
        The vocabulary of rules.
    """

    def __init__(self, memory: Memory, shipped: Shipped, words: tuple[Word, ...]) -> None:
        self._memory = memory
        self._shipped = shipped
        self._affordance_words = frozenset(
            word.name for word in words if word.takes == "affordance"
        )

    def graph(self) -> Graph:
        """Return all that is known as one ontology."""
        with self._memory.reading() as learned:
            copy = learned.after(Change())
        return graph_of(self._shipped, copy, self._affordance_words)

    def version(self) -> int:
        """Return another number after every change."""
        with self._memory.reading():
            return self._memory.version

    def export(self) -> KnowledgeDocument:
        """Return all that is known as Turtle."""
        return KnowledgeDocument(turtle=self.graph().serialize(format="turtle"))

    def take_over(self, wanted: KnowledgeImport) -> KnowledgeImported:
        """Learn what a document holds: all of it, or nothing.

        What is known already and the same is passed over.

        Raises
        ------
        InvalidInput
            It is not Turtle, or something in it cannot be used; see `add_task`,
            `add_rule`.
        Conflict
            It does not agree with what is shipped, or, unless it replaces what was
            learned, with that.
        """
        document = read_document(wanted.turtle, self._shipped, self._affordance_words)
        change = document.change.model_copy(update={"clear": wanted.replace})
        with self._memory.reading() as learned:
            if not wanted.replace:
                change = _without_known(change, learned)
        self._memory.change(change)
        return KnowledgeImported(
            tasks=tuple(each.name for each in change.tasks),
            affordances=tuple(each.name for each in change.affordances),
            rules=tuple(each.name for each in change.rules),
            ignored=document.ignored,
        )


def _without_known(change: Change, learned: Learned) -> Change:
    """Return `change` without what is learned already just as it says."""
    return change.model_copy(
        update={
            "tasks": tuple(e for e in change.tasks if learned.tasks.get(e.name) != e),
            "affordances": tuple(
                e for e in change.affordances if learned.affordances.get(e.name) != e
            ),
            "rules": tuple(e for e in change.rules if learned.rules.get(e.name) != e),
        }
    )
