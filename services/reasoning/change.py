"""A change of what was learned, and its effect."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TypeVar

from shared.schemas.rule import RuleDefinition
from shared.schemas.task import Affordance, TaskDefinition
from shared.wire import Message

_Item = TypeVar("_Item")


class Change(Message):
    """What is forgotten and what is learned, in one step; a record of the journal."""

    clear: bool = False
    """Forget everything first."""
    forget_tasks: tuple[str, ...] = ()
    forget_affordances: tuple[str, ...] = ()
    forget_rules: tuple[str, ...] = ()
    tasks: tuple[TaskDefinition, ...] = ()
    affordances: tuple[Affordance, ...] = ()
    rules: tuple[RuleDefinition, ...] = ()


@dataclass
class Learned:
    """Everything that was added to the shipped knowledge, by name."""

    tasks: dict[str, TaskDefinition] = field(default_factory=dict)
    affordances: dict[str, Affordance] = field(default_factory=dict)
    rules: dict[str, RuleDefinition] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.tasks) + len(self.affordances) + len(self.rules)

    def apply(self, change: Change) -> None:
        """Take the effect of `change`."""
        if change.clear:
            self.tasks.clear()
            self.affordances.clear()
            self.rules.clear()
        _forget(self.tasks, change.forget_tasks)
        _forget(self.affordances, change.forget_affordances)
        _forget(self.rules, change.forget_rules)
        self.tasks.update((each.name, each) for each in change.tasks)
        self.affordances.update((each.name, each) for each in change.affordances)
        self.rules.update((each.name, each) for each in change.rules)

    def after(self, change: Change) -> Learned:
        """Return what `change` makes of it; it stays as it is."""
        result = Learned(dict(self.tasks), dict(self.affordances), dict(self.rules))
        result.apply(change)
        return result

    def snapshot(self) -> Change:
        """Return the change that leads here from anywhere."""
        return Change(
            clear=True,
            tasks=tuple(self.tasks.values()),
            affordances=tuple(self.affordances.values()),
            rules=tuple(self.rules.values()),
        )

    def tasks_with_rules(self) -> set[str]:
        """Return the tasks that Version 1 learned rules for."""
        return {rule.task for rule in self.rules.values() if rule.task is not None}

    def rules_for(self, affordance: str) -> list[RuleDefinition]:
        """Return the learned rules for an affordance."""
        return [rule for rule in self.rules.values() if rule.affordance == affordance]


def _forget(known: dict[str, _Item], names: Iterable[str]) -> None:
    for name in names:
        known.pop(name, None)
