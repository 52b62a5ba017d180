"""What is known about tasks: the shipped ontology and the tasks added to it."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Mapping

from services.reasoning.definition import checked, listed
from services.reasoning.ontology import affordances_in, load_ontology, tasks_in, triples_of
from services.reasoning.prolog import Prolog
from services.reasoning.settings import ReasoningSettings
from services.reasoning.task_store import TaskStore
from shared.errors import Conflict, InternalError, InvalidInput, NotFound, UnknownTask
from shared.schemas.task import Affordance, RuleSet, Task, TaskDefinition, Version

_numbers = itertools.count()


class Knowledge:
    """Tasks and affordances, in Python for listing and in Prolog for proving.

    Prolog is told of a change when it happens, not with every request, and only
    of what changed.

    Parameters
    ----------
    settings : ReasoningSettings
        Where the ontology and the added tasks lie.
    prolog : Prolog
    rules : mapping
        For each rule set, what Prolog has rules for: the tasks of Version 1
        (`tasks`) and the affordances of Version 2 (`affordances`).

    Raises
    ------
    InternalError
        The ontology or an added task is not usable, or an affordance has no rule.
    """

    def __init__(
        self,
        settings: ReasoningSettings,
        prolog: Prolog,
        rules: Mapping[RuleSet, Mapping[str, list[str]]],
    ) -> None:
        self.name = f"knowledge_{next(_numbers)}"
        self._prolog = prolog
        self._rules = rules
        self._lock = threading.Lock()
        self._store = TaskStore(settings.knowledge_dir)
        graph = load_ontology(settings.ontology_file)
        self._affordances = affordances_in(graph)
        self._shipped = tasks_in(graph)
        self._added = self._store.read()
        self._check()
        everything = {**self._shipped, **self._added}
        prolog.ask("learn", knowledge=self.name, triples=triples_of(everything.values()))

    def close(self) -> None:
        """Let Prolog forget it."""
        self._prolog.ask("forget_all", knowledge=self.name)

    def tasks(self) -> tuple[Task, ...]:
        """Return every task, by name, with the versions that know it."""
        with self._lock:
            known = {**self._shipped, **self._added}
        only_rules = {task for rules in self._rules.values() for task in rules["tasks"]} - set(
            known
        )
        known |= {name: TaskDefinition(name=name) for name in only_rules}
        return tuple(self._task(known[name]) for name in sorted(known))

    def affordances(self) -> tuple[Affordance, ...]:
        """Return every affordance, by name."""
        return tuple(self._affordances.values())

    def add(self, definition: TaskDefinition) -> Task:
        """Add a Version 2 task; the next request knows it, and so does the next start.

        Raises
        ------
        InvalidInput
            An affordance that is not known, or no part to hold.
        Conflict
            The name is taken.
        StageUnavailable
            It cannot be stored.
        """
        definition = checked(definition, self._affordances)
        with self._lock:
            self._refuse_taken(definition.name)
            self._store.write(definition)
            self._prolog.ask("learn", knowledge=self.name, triples=triples_of([definition]))
            self._added = {**self._added, definition.name: definition}
        return self._task(definition)

    def delete(self, name: str) -> Task:
        """Forget a task that was added.

        Raises
        ------
        NotFound
            There is no such task.
        Conflict
            It is part of the shipped knowledge.
        StageUnavailable
            It cannot be removed from the store.
        """
        with self._lock:
            if name in self._shipped or name in self._ruled_tasks():
                raise Conflict(
                    f"the task {name!r} is part of the shipped knowledge and cannot be deleted",
                    task=name,
                )
            if name not in self._added:
                raise NotFound(
                    f"there is no task {name!r} to delete", task=name, added=sorted(self._added)
                )
            self._store.remove(name)
            self._prolog.ask("forget", knowledge=self.name, subject=name)
            gone = self._added[name]
            self._added = {key: task for key, task in self._added.items() if key != name}
        return self._task(gone)

    def unknown(self, asked: str, version: Version, rule_set: RuleSet) -> UnknownTask:
        """Return the error for a task that `version` does not know."""
        by_version: dict[Version, list[str]] = {
            "v1": sorted(self._rules[rule_set]["tasks"]),
            "v2": [task.name for task in self.tasks() if "v2" in task.reasoning],
        }
        known = by_version[version]
        others = [other for other, names in by_version.items() if asked in names]
        if others:
            why = (
                f"reasoning v1 has no rule for {asked!r} (reasoning {others[0]} knows it)"
                if version == "v1"
                else f"reasoning v2 has no relations for {asked!r} (reasoning {others[0]} knows it)"
            )
        else:
            why = f"there is no task {asked!r}"
        return UnknownTask(
            f"{why}; reasoning {version} knows {listed(known)}",
            field="task",
            found=asked,
            known=known,
            reasoning=version,
            known_to=others,
        )

    def _task(self, definition: TaskDefinition) -> Task:
        name = definition.name
        versions: list[Version] = ["v1"] if name in self._ruled_tasks() else []
        if definition.grasp or definition.avoids:
            versions.append("v2")
        return Task(
            **dict(definition),
            reasoning=tuple(versions),
            builtin=name in self._shipped or name in self._ruled_tasks(),
        )

    def _ruled_tasks(self) -> set[str]:
        return {task for rules in self._rules.values() for task in rules["tasks"]}

    def _refuse_taken(self, name: str) -> None:
        if name in self._shipped or name in self._added or name in self._ruled_tasks():
            raise Conflict(f"there is a task {name!r} already", field="name", found=name)
        if name in self._affordances:
            raise Conflict(
                f"{name!r} is the name of an affordance; a task needs another",
                field="name",
                found=name,
            )

    def _check(self) -> None:
        for rule_set, rules in self._rules.items():
            without = sorted(set(self._affordances) ^ set(rules["affordances"]))
            if without:
                raise InternalError(
                    f"rule set {rule_set!r} and the ontology do not agree on {listed(without)}: "
                    "each affordance needs a rule, and each rule an affordance"
                )
        for name, task in {**self._shipped, **self._added}.items():
            try:
                checked(task, self._affordances)
            except InvalidInput as error:
                raise InternalError(f"the task {name!r} is not usable: {error.message}") from error
        if both := sorted((set(self._shipped) | set(self._affordances)) & set(self._added)):
            raise InternalError(f"added tasks with the name of shipped knowledge: {listed(both)}")
