"""What is known before anything is learned: the ontology and the rule files."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

from rdflib import Graph

from services.reasoning.definition import checked, listed
from services.reasoning.ontology import affordances_in, load_ontology, tasks_in
from shared.errors import InternalError, InvalidInput
from shared.schemas.task import Affordance, RuleSet, TaskDefinition


@dataclass(frozen=True)
class RuleFiles:
    """What Prolog found in the files of a rule set.

    Attributes
    ----------
    tasks : collection of str
        Those with a rule in Version 1.
    affordances : collection of str
        Those with a rule in Version 2.
    uses : collection of (str, str)
        An affordance, and another that a rule for it asks for.
    """

    tasks: Collection[str]
    affordances: Collection[str]
    uses: Collection[tuple[str, str]] = ()


@dataclass(frozen=True)
class Shipped:
    """The ontology's tasks and affordances by name, and the rule sets."""

    tasks: Mapping[str, TaskDefinition]
    affordances: Mapping[str, Affordance]
    rule_sets: Mapping[RuleSet, RuleFiles]
    graph: Graph
    """Everything that the ontology states."""

    @property
    def ruled_tasks(self) -> frozenset[str]:
        """The tasks with a Version 1 rule in any rule set."""
        return frozenset(task for files in self.rule_sets.values() for task in files.tasks)

    @property
    def task_names(self) -> frozenset[str]:
        """The tasks that any version knows."""
        return self.ruled_tasks | frozenset(self.tasks)


def read_shipped(ontology_file: Path, rule_sets: Mapping[RuleSet, RuleFiles]) -> Shipped:
    """Return the shipped knowledge.

    Raises
    ------
    InternalError
        The ontology cannot be used, or does not agree with the rules: a task
        with relations to something that is no affordance, an affordance for
        which no rule set has a rule, or a rule for what is none.
    """
    graph = load_ontology(ontology_file)
    affordances, tasks = affordances_in(graph), tasks_in(graph)
    for rule_set, files in rule_sets.items():
        if unknown := sorted(set(files.affordances) - set(affordances)):
            raise InternalError(
                f"rule set {rule_set!r} and the ontology do not agree on {listed(unknown)}: "
                "each rule is for an affordance of the ontology"
            )
    ruled = {name for files in rule_sets.values() for name in files.affordances}
    if without := sorted(set(affordances) - ruled):
        raise InternalError(f"no rule set has a rule for the affordance {listed(without)}")
    for name, task in tasks.items():
        try:
            checked(task, affordances)
        except InvalidInput as error:
            raise InternalError(f"the task {name!r} is not usable: {error.message}") from error
    return Shipped(tasks, affordances, rule_sets, graph)
