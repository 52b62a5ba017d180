"""The reasoning stage: asks Prolog and turns its proof into the answer."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import get_args

from services.reasoning.admission import Admission
from services.reasoning.archive import Archive
from services.reasoning.confidence import Map, read_maps
from services.reasoning.enquiry import Enquiry
from services.reasoning.explanation import explain_found, explain_joining, explain_miss
from services.reasoning.facts import facts_of, layout_facts
from services.reasoning.knowledge import Knowledge
from services.reasoning.memory import Memory
from services.reasoning.prolog import Prolog, prolog
from services.reasoning.proof import trace_of
from services.reasoning.reasons import reason_for
from services.reasoning.settings import ReasoningSettings
from services.reasoning.shipped import RuleFiles, read_shipped
from services.reasoning.wholes import Wholes, as_they_are, joined
from shared.errors import JsonObject
from shared.schemas.knowledge import (
    AskQuestion,
    KnowledgeDocument,
    KnowledgeImport,
    KnowledgeImported,
    QuestionAnswer,
    QuestionList,
    SparqlAnswer,
    SparqlQuery,
)
from shared.schemas.route import Nothing
from shared.schemas.rule import (
    AffordanceDefinition,
    AffordanceName,
    Rule,
    RuleDefinition,
    RuleList,
    RuleName,
    Word,
)
from shared.schemas.task import (
    Affordance,
    AffordanceList,
    DecideRequest,
    DecideResponse,
    Explanation,
    Reason,
    Region,
    RuleSet,
    Task,
    TaskDefinition,
    TaskList,
    TaskName,
)


@dataclass(frozen=True)
class Warm:
    """What a reasoner works with once it is warm."""

    engine: Prolog
    knowledge: Knowledge
    archive: Archive
    enquiry: Enquiry
    confidence: Mapping[str, Map]


class Reasoner:
    """Answers the routes of reasoning; safe to call from several threads.

    Parameters
    ----------
    settings : ReasoningSettings
    """

    def __init__(self, settings: ReasoningSettings) -> None:
        self._settings = settings
        self._lock = threading.Lock()
        self._ready: Warm | None = None

    def warm_up(self) -> None:
        """Start Prolog, load the rules, the ontology and the added tasks; once.

        Raises
        ------
        StageUnavailable
            SWI-Prolog is not installed.
        InternalError
            Rules, ontology or an added task that cannot be used; says which.
        """
        self._warm()

    def close(self) -> None:
        """Forget this reasoner's knowledge; the process keeps its Prolog."""
        with self._lock:
            if self._ready is not None:
                self._ready.enquiry.close()
                self._ready.knowledge.close()
                self._ready = None

    def decide(self, request: DecideRequest) -> DecideResponse:
        """Find the part to hold for a task.

        Raises
        ------
        UnknownTask
            The asked version does not know the task; lists those that it knows.
        InvalidInput
            Primitives that cannot be reasoned about.
        DeadlineExceeded
            Prolog came to no end.
        """
        warm = self._warm()
        engine, knowledge = warm.engine, warm.knowledge
        knowledge.refresh()
        wholes = as_they_are(request.primitives, request.joints)
        decision = self._ask(engine, knowledge.name, request, wholes, join=True)
        joining: Sequence[JsonObject] = ()
        if decision["outcome"] == "joined":
            joining = decision["traces"]
            wholes = joined(request.primitives, request.joints, decision["groups"])
            decision = self._ask(engine, knowledge.name, request, wholes, join=False)
        if decision["outcome"] == "unknown_task":
            raise knowledge.unknown(request.task, request.reasoning, request.rule_set)
        confidence = warm.confidence.get(request.rule_set, float)
        return _response(request, decision, wholes, joining, confidence)

    def _ask(
        self, engine: Prolog, knowledge: str, request: DecideRequest, parts: Wholes, *, join: bool
    ) -> JsonObject:
        return engine.ask(
            "decide",
            timeout_s=self._settings.max_wait_s,
            knowledge=knowledge,
            rule_set=request.rule_set,
            version=request.reasoning,
            task=request.task,
            join=join,
            max_inferences=self._settings.max_inferences,
            parts=facts_of(parts.primitives, self._settings.max_primitives),
            layout=layout_facts(
                parts.primitives, parts.joints, request.plane, request.gripper_opening
            ),
        )

    def list_tasks(self, _: Nothing) -> TaskList:
        """Return every task that is known."""
        return TaskList(tasks=self._warm().knowledge.tasks())

    def add_task(self, definition: TaskDefinition) -> Task:
        """Add a Version 2 task; see `Knowledge.add_task`."""
        return self._warm().knowledge.add_task(definition)

    def delete_task(self, task: TaskName) -> Task:
        """Delete an added task; see `Knowledge.delete_task`."""
        return self._warm().knowledge.delete_task(task.name)

    def list_affordances(self, _: Nothing) -> AffordanceList:
        """Return every part affordance."""
        return AffordanceList(affordances=self._warm().knowledge.affordances())

    def add_affordance(self, definition: AffordanceDefinition) -> Affordance:
        """Add an affordance with its rules; see `Knowledge.add_affordance`."""
        return self._warm().knowledge.add_affordance(definition)

    def delete_affordance(self, affordance: AffordanceName) -> Affordance:
        """Delete an added affordance; see `Knowledge.delete_affordance`."""
        return self._warm().knowledge.delete_affordance(affordance.name)

    def list_rules(self, _: Nothing) -> RuleList:
        """Return the taught rules and the vocabulary."""
        return self._warm().knowledge.rules()

    def add_rule(self, definition: RuleDefinition) -> Rule:
        """Teach a rule; see `Knowledge.add_rule`."""
        return self._warm().knowledge.add_rule(definition)

    def delete_rule(self, rule: RuleName) -> Rule:
        """Forget a taught rule; see `Knowledge.delete_rule`."""
        return self._warm().knowledge.delete_rule(rule.name)

    def export_knowledge(self, _: Nothing) -> KnowledgeDocument:
        """Return all that is known as Turtle."""
        return self._warm().archive.export()

    def import_knowledge(self, wanted: KnowledgeImport) -> KnowledgeImported:
        """Learn from a Turtle document; see `Archive.take_over`."""
        return self._warm().archive.take_over(wanted)

    def query_knowledge(self, asked: SparqlQuery) -> SparqlAnswer:
        """Answer a SPARQL query; see `Enquiry.query`."""
        return self._warm().enquiry.query(asked)

    def list_questions(self, _: Nothing) -> QuestionList:
        """Return the questions of the ontology."""
        return self._warm().enquiry.questions()

    def ask_question(self, asked: AskQuestion) -> QuestionAnswer:
        """Answer one of them; see `Enquiry.ask`."""
        return self._warm().enquiry.ask(asked)

    def _warm(self) -> Warm:
        with self._lock:
            if self._ready is None:
                engine = prolog(self._settings.rules_dir)
                self._ready = _warm(self._settings, engine)
            return self._ready


def _warm(settings: ReasoningSettings, engine: Prolog) -> Warm:
    rule_sets: dict[RuleSet, RuleFiles] = {
        rule_set: RuleFiles(
            **engine.ask("load", directory=str(engine.rules_dir), rule_set=rule_set)
        )
        for rule_set in get_args(RuleSet)
    }
    shipped = read_shipped(settings.ontology_file, rule_sets)
    words = tuple(Word.model_validate(word) for word in engine.ask("vocabulary")["words"])
    admission = Admission(shipped, {word.name: word for word in words}, settings.max_learned)
    memory = Memory(settings, engine, admission)
    knowledge, archive = Knowledge(memory, shipped, words), Archive(memory, shipped, words)
    maps = {} if settings.confidence_file is None else read_maps(settings.confidence_file)
    return Warm(engine, knowledge, archive, Enquiry(settings, knowledge, archive), maps)


def _response(
    request: DecideRequest,
    decision: JsonObject,
    wholes: Wholes,
    joining: Sequence[JsonObject],
    confidence: Callable[[float], float],
) -> DecideResponse:
    found = decision["outcome"] == "found"
    reason = None if found else reason_for(request.task, decision)
    regions = [
        Region(
            primitive_ids=wholes.ids(region["parts"]),
            affordance=region["affordance"],
            confidence=confidence(region["confidence"]),
        )
        for region in decision["regions"]
    ]
    return DecideResponse(
        found=found,
        reason=reason,
        region=regions[0] if found else None,
        alternatives=tuple(regions[1:]),
        labels={
            piece: tuple(label["affordances"].split())
            for label in decision["labels"]
            for piece in wholes.ids([label["part"]])
        },
        explanation=_explanation(request, decision, reason, wholes, joining)
        if request.explain
        else None,
    )


def _explanation(
    request: DecideRequest,
    decision: JsonObject,
    reason: Reason | None,
    wholes: Wholes,
    joining: Sequence[JsonObject],
) -> Explanation:
    miss = decision["miss"]
    if reason is None:
        text = explain_found(request.task, decision, wholes)
    else:
        text = explain_miss(request.task, reason.message, miss, wholes, decision["lacking"])
    return Explanation(
        text=" ".join([text, *explain_joining(wholes)]),
        facts=tuple(decision["facts"].splitlines()),
        rules=tuple(map(trace_of, [*decision["traces"], *joining])),
        nearest_miss=None if miss is None else trace_of(miss),
    )
