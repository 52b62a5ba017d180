"""What is known about tasks and affordances: shipped, and learned while running."""

from __future__ import annotations

from services.reasoning.admission import require_known
from services.reasoning.change import Change
from services.reasoning.definition import listed
from services.reasoning.memory import Memory
from services.reasoning.shipped import Shipped
from shared.errors import Conflict, NotFound, UnknownTask
from shared.schemas.rule import AffordanceDefinition, Rule, RuleDefinition, RuleList, Word
from shared.schemas.task import Affordance, RuleSet, Task, TaskDefinition, Version


class Knowledge:
    """What can be asked for and what can be added, over HTTP or otherwise.

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
        self._words = words

    @property
    def name(self) -> str:
        """Of the knowledge base in Prolog."""
        return self._memory.name

    def close(self) -> None:
        """Let Prolog forget it."""
        self._memory.close()

    def refresh(self) -> None:
        """Take over what other processes changed; costs one `stat` when there is nothing.

        Raises
        ------
        InternalError
            The stored knowledge is damaged.
        """
        self._memory.refresh()

    def tasks(self) -> tuple[Task, ...]:
        """Return every task, by name, with the versions that know it."""
        with self._memory.reading() as learned:
            ruled = learned.tasks_with_rules()
            known = {name: TaskDefinition(name=name) for name in self._shipped.ruled_tasks | ruled}
            known |= {**self._shipped.tasks, **learned.tasks}
            return tuple(self._task(known[name], ruled) for name in sorted(known))

    def affordances(self) -> tuple[Affordance, ...]:
        """Return every affordance, by name."""
        with self._memory.reading() as learned:
            known = {**self._shipped.affordances, **learned.affordances}
            return tuple(known[name] for name in sorted(known))

    def rules(self) -> RuleList:
        """Return the learned rules by name, and the words to write further ones."""
        with self._memory.reading() as learned:
            clauses = self._memory.clauses()
            rules = [
                Rule(**dict(learned.rules[name]), prolog=clauses[name])
                for name in sorted(learned.rules)
            ]
        return RuleList(rules=tuple(rules), vocabulary=self._words)

    def add_task(self, definition: TaskDefinition) -> Task:
        """Add a Version 2 task; the next request knows it, and so does the next start.

        Raises
        ------
        InvalidInput
            An affordance that is not known, or no part to hold.
        Conflict
            The name is taken.
        NotStored
            It cannot be stored.
        """
        (admitted,) = self._memory.change(Change(tasks=(definition,))).tasks
        with self._memory.reading() as learned:
            return self._task(admitted, learned.tasks_with_rules())

    def delete_task(self, name: str) -> Task:
        """Forget a task that was added.

        Raises
        ------
        NotFound
            There is no such task.
        Conflict
            It is part of the shipped knowledge, or only known by a taught rule.
        NotStored
            It cannot be removed from the store.
        """
        with self._memory.reading() as learned:
            if name in self._shipped.task_names:
                raise _is_shipped("task", name)
            gone = learned.tasks.get(name)
            rules = [each.name for each in learned.rules.values() if each.task == name]
            if gone is None and rules:
                raise Conflict(
                    f"the task {name!r} is known by the taught rules {listed(rules)}; "
                    "it goes with them",
                    task=name,
                    rules=rules,
                )
            if gone is None:
                added = sorted(learned.tasks)
                raise NotFound(f"there is no task {name!r} to delete", task=name, added=added[:100])
            task = self._task(gone, learned.tasks_with_rules())
        self._memory.change(Change(forget_tasks=(name,)))
        return task

    def add_affordance(self, definition: AffordanceDefinition) -> Affordance:
        """Add an affordance with the rules that find it.

        Raises
        ------
        InvalidInput, Conflict, NotStored
            As for rules; nothing of it is kept.
        """
        affordance = Affordance(name=definition.name, description=definition.description)
        rules = tuple(
            RuleDefinition(**dict(body), affordance=definition.name) for body in definition.rules
        )
        self._memory.change(Change(affordances=(affordance,), rules=rules))
        return affordance

    def delete_affordance(self, name: str) -> Affordance:
        """Forget an affordance that was added, and its rules.

        Raises
        ------
        NotFound
            There is no such affordance.
        Conflict
            It is part of the shipped knowledge, or a task or a rule asks for it.
        """
        with self._memory.reading() as learned:
            if name in self._shipped.affordances:
                raise _is_shipped("affordance", name)
            require_known([name], learned.affordances, "affordance")
            gone = learned.affordances[name]
            rules = tuple(each.name for each in learned.rules_for(name))
        self._memory.change(Change(forget_affordances=(name,), forget_rules=rules))
        return gone

    def add_rule(self, definition: RuleDefinition) -> Rule:
        """Teach a rule for a Version 1 task or a Version 2 affordance.

        Raises
        ------
        InvalidInput
            A word, an affordance or a value that cannot be used, or bounds that
            no part satisfies.
        Conflict
            The name is taken, or affordances would ask for each other in a circle.
        NotStored
            It cannot be stored.
        """
        (admitted,) = self._memory.change(Change(rules=(definition,))).rules
        return self._rule(admitted)

    def delete_rule(self, name: str) -> Rule:
        """Forget a taught rule.

        Raises
        ------
        NotFound
            There is no such rule.
        Conflict
            It is the last rule of an affordance.
        """
        with self._memory.reading() as learned:
            require_known([name], learned.rules, "rule")
            gone = self._rule(learned.rules[name])
        self._memory.change(Change(forget_rules=(name,)))
        return gone

    def unknown(self, asked: str, version: Version, rule_set: RuleSet) -> UnknownTask:
        """Return the error for a task that `version` does not know."""
        tasks = self.tasks()
        with self._memory.reading() as learned:
            ruled = {*self._shipped.rule_sets[rule_set].tasks, *learned.tasks_with_rules()}
        by_version: dict[Version, list[str]] = {
            "v1": sorted(ruled),
            "v2": [task.name for task in tasks if "v2" in task.reasoning],
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

    def _rule(self, definition: RuleDefinition) -> Rule:
        clauses = self._memory.clauses(definition.name)
        return Rule(**dict(definition), prolog=clauses.get(definition.name, ""))  # just forgotten

    def _task(self, definition: TaskDefinition, ruled: set[str]) -> Task:
        name = definition.name
        by_rule = name in self._shipped.ruled_tasks or name in ruled
        versions: list[Version] = ["v1"] if by_rule else []
        if definition.grasp or definition.avoids:
            versions.append("v2")
        return Task(
            **dict(definition),
            reasoning=tuple(versions),
            builtin=name in self._shipped.task_names,
        )


def _is_shipped(kind: str, name: str) -> Conflict:
    return Conflict(
        f"the {kind} {name!r} is part of the shipped knowledge and cannot be deleted",
        **{kind: name},
    )
