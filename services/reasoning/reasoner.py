"""The reasoning stage: asks Prolog and turns its proof into the answer."""

from __future__ import annotations

import threading
from typing import get_args

from services.reasoning.explanation import explain_found, explain_miss
from services.reasoning.facts import facts_of
from services.reasoning.knowledge import Knowledge
from services.reasoning.prolog import Prolog, prolog
from services.reasoning.proof import trace_of
from services.reasoning.reasons import reason_for
from services.reasoning.settings import ReasoningSettings
from shared.errors import JsonObject
from shared.schemas.route import Nothing
from shared.schemas.task import (
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


class Reasoner:
    """Answers the routes of reasoning; safe to call from several threads.

    Parameters
    ----------
    settings : ReasoningSettings
    """

    def __init__(self, settings: ReasoningSettings) -> None:
        self._settings = settings
        self._lock = threading.Lock()
        self._ready: tuple[Prolog, Knowledge] | None = None

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
                self._ready[1].close()
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
        engine, knowledge = self._warm()
        decision = engine.ask(
            "decide",
            timeout_s=self._settings.max_wait_s,
            knowledge=knowledge.name,
            rule_set=request.rule_set,
            version=request.reasoning,
            task=request.task,
            max_inferences=self._settings.max_inferences,
            parts=facts_of(request.primitives, self._settings.max_primitives),
        )
        if decision["outcome"] == "unknown_task":
            raise knowledge.unknown(request.task, request.reasoning, request.rule_set)
        return _response(request, decision)

    def list_tasks(self, _: Nothing) -> TaskList:
        """Return every task that is known."""
        return TaskList(tasks=self._warm()[1].tasks())

    def add_task(self, definition: TaskDefinition) -> Task:
        """Add a Version 2 task; see `Knowledge.add`."""
        return self._warm()[1].add(definition)

    def delete_task(self, task: TaskName) -> Task:
        """Delete an added task; see `Knowledge.delete`."""
        return self._warm()[1].delete(task.name)

    def list_affordances(self, _: Nothing) -> AffordanceList:
        """Return every part affordance."""
        return AffordanceList(affordances=self._warm()[1].affordances())

    def _warm(self) -> tuple[Prolog, Knowledge]:
        with self._lock:
            if self._ready is None:
                engine = prolog(self._settings.rules_dir)
                rules = {
                    rule_set: engine.ask("load", directory=str(engine.rules_dir), rule_set=rule_set)
                    for rule_set in get_args(RuleSet)
                }
                self._ready = engine, Knowledge(self._settings, engine, rules)
            return self._ready


def _response(request: DecideRequest, decision: JsonObject) -> DecideResponse:
    found = decision["outcome"] == "found"
    reason = None if found else reason_for(request.task, decision)
    regions = [
        Region(
            primitive_ids=region["parts"],
            affordance=region["affordance"],
            confidence=region["confidence"],
        )
        for region in decision["regions"]
    ]
    return DecideResponse(
        found=found,
        reason=reason,
        region=regions[0] if found else None,
        alternatives=tuple(regions[1:]),
        labels={label["part"]: tuple(label["affordances"]) for label in decision["labels"]},
        explanation=_explanation(request, decision, reason) if request.explain else None,
    )


def _explanation(
    request: DecideRequest, decision: JsonObject, reason: Reason | None
) -> Explanation:
    parts = {primitive.id: primitive for primitive in request.primitives}
    miss = decision["miss"]
    if reason is None:
        text = explain_found(request.task, decision, parts)
    else:
        text = explain_miss(request.task, reason.message, miss, parts, decision["lacking"])
    return Explanation(
        text=text,
        facts=tuple(decision["facts"]),
        rules=tuple(map(trace_of, decision["traces"])),
        nearest_miss=None if miss is None else trace_of(miss),
    )
