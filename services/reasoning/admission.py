"""Whether a change fits what is known; it is taken whole or refused whole."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from services.reasoning.change import Change, Learned
from services.reasoning.definition import checked, listed
from services.reasoning.problem import refused
from services.reasoning.rule_problems import Terms, problems_of
from services.reasoning.shipped import Shipped
from shared.errors import Conflict, NotFound
from shared.schemas.rule import RuleDefinition, Word


@dataclass(frozen=True)
class Admission:
    """Decides about changes of what was learned.

    Attributes
    ----------
    shipped : Shipped
    words : mapping
        The vocabulary of rules, by name.
    max_learned : int
        So many tasks, affordances and rules can be learned.
    """

    shipped: Shipped
    words: Mapping[str, Word]
    max_learned: int

    def admit(self, change: Change, learned: Learned) -> Change:
        """Return `change` ready to be stored, with relations and shape classes sorted.

        Parameters
        ----------
        change : Change
        learned : Learned
            What is known before; names in it are taken unless the change
            forgets them.

        Raises
        ------
        Conflict
            A name is taken, something is still needed, affordances ask for each
            other in a circle, or there is too much.
        InvalidInput
            An affordance that is not known, a task without a part to hold, a
            rule that no part can satisfy.
        NotFound
            Something is to be forgotten that was not learned.
        """
        kept = learned.after(change.model_copy(update=_NOTHING_NEW))
        require_known(change.forget_tasks, learned.tasks, "task")
        require_known(change.forget_affordances, learned.affordances, "affordance")
        require_known(change.forget_rules, learned.rules, "rule")
        after = learned.after(change)
        if len(after) > self.max_learned:
            raise Conflict(
                f"the knowledge would hold {len(after)} learned things; "
                f"it takes {self.max_learned} (SPARGE_REASONING_MAX_LEARNED)",
                found=len(after),
                allowed=self.max_learned,
            )
        self._names(change, kept, after)
        affordances = {*self.shipped.affordances, *after.affordances}
        tasks = tuple(checked(task, affordances) for task in change.tasks)
        self._rules(change.rules, after, affordances)
        self._needed(change, after, affordances)
        rules = tuple(self._tidy(rule) for rule in change.rules)
        return change.model_copy(update={"tasks": tasks, "rules": rules})

    def _names(self, change: Change, kept: Learned, after: Learned) -> None:
        """Every name has one meaning: tasks and affordances differ, and none is learned twice."""
        for kind, names, taken in (
            ("task", [each.name for each in change.tasks], {*self.shipped.task_names, *kept.tasks}),
            (
                "affordance",
                [each.name for each in change.affordances],
                {*self.shipped.affordances, *kept.affordances},
            ),
            ("rule", [each.name for each in change.rules], set(kept.rules)),
        ):
            for name in names:
                if name in taken or names.count(name) > 1:
                    raise Conflict(f"there is a {kind} {name!r} already", field="name", found=name)
        new_tasks = {*(each.name for each in change.tasks), *_tasks_of(change.rules)}
        new_affordances = {each.name for each in change.affordances}
        all_tasks = {*self.shipped.task_names, *after.tasks, *after.tasks_with_rules()}
        all_affordances = {*self.shipped.affordances, *after.affordances}
        if both := sorted(new_tasks & all_affordances):
            raise Conflict(
                f"{both[0]!r} is the name of an affordance; a task needs another",
                field="name",
                found=both[0],
            )
        if both := sorted(new_affordances & all_tasks):
            raise Conflict(
                f"{both[0]!r} is the name of a task; an affordance needs another",
                field="name",
                found=both[0],
            )

    def _needed(self, change: Change, after: Learned, affordances: set[str]) -> None:
        """Check that nothing asks for what is forgotten, and that every affordance keeps a rule."""
        ruled = {rule.affordance for rule in after.rules.values()}
        if without := sorted(set(after.affordances) - ruled):
            raise Conflict(
                f"the affordance {without[0]!r} would be left without a rule", found=without[0]
            )
        if not (change.clear or change.forget_affordances):
            return
        for task in after.tasks.values():
            if gone := sorted({*task.requires, *task.grasp, *task.avoids} - affordances):
                raise Conflict(
                    f"the task {task.name!r} asks for the affordance {gone[0]!r}", found=gone[0]
                )
        for rule in after.rules.values():
            if gone := sorted({rule.affordance or "", *self._asked_by(rule)} - affordances - {""}):
                raise Conflict(
                    f"the rule {rule.name!r} asks for the affordance {gone[0]!r}", found=gone[0]
                )

    def _rules(
        self, rules: Iterable[RuleDefinition], after: Learned, affordances: set[str]
    ) -> None:
        terms = Terms(self.words, affordances)
        new_edges = False
        for rule in rules:
            if problems := problems_of(rule, terms, affordance=rule.affordance):
                raise refused(f"the rule {rule.name!r}", problems)
            new_edges = new_edges or (rule.affordance is not None and bool(self._asked_by(rule)))
        if new_edges and (circle := self._circle(after)):
            raise Conflict(
                f"these affordances would ask for each other in a circle: {' -> '.join(circle)}",
                found=circle,
            )

    def _tidy(self, rule: RuleDefinition) -> RuleDefinition:
        """Return `rule` with shape classes sorted, each listed once."""
        conditions = []
        for each in rule.conditions:
            if self.words[each.condition].takes == "shapes":
                names = each.value if isinstance(each.value, tuple) else (each.value,)
                each = each.model_copy(update={"value": tuple(sorted({str(n) for n in names}))})
            conditions.append(each)
        return rule.model_copy(update={"conditions": tuple(conditions)})

    def _asked_by(self, rule: RuleDefinition) -> set[str]:
        """Return the affordances that the conditions of `rule` ask for."""
        return {
            each.value
            for each in rule.conditions
            if (word := self.words.get(each.condition)) is not None
            and word.takes == "affordance"
            and isinstance(each.value, str)
        }

    def _circle(self, after: Learned) -> list[str]:
        """Return affordances whose rules lead back to the first one; empty if there are none."""
        asks: dict[str, set[str]] = {}
        for files in self.shipped.rule_sets.values():
            for affordance, other in files.uses:
                asks.setdefault(affordance, set()).add(other)
        for rule in after.rules.values():
            if rule.affordance is not None:
                asks.setdefault(rule.affordance, set()).update(self._asked_by(rule))
        done: set[str] = set()
        for start in sorted(asks):
            if circle := _circle_from(start, asks, [], done):
                return circle
        return []


_NOTHING_NEW: dict[str, tuple[()]] = {"tasks": (), "affordances": (), "rules": ()}


def _tasks_of(rules: Iterable[RuleDefinition]) -> set[str]:
    return {rule.task for rule in rules if rule.task is not None}


def require_known(names: Iterable[str], learned: Mapping[str, object], kind: str) -> None:
    """Raise `NotFound` for a name that was not learned."""
    for name in names:
        if name not in learned:
            raise NotFound(
                f"there is no {kind} {name!r} that was added; "
                f"added are {listed(sorted(learned)[:20])}",
                found=name,
                added=sorted(learned)[:100],
            )


def _circle_from(
    start: str, asks: Mapping[str, set[str]], path: list[str], done: set[str]
) -> list[str]:
    if start in path:
        return [*path[path.index(start) :], start]
    if start in done:
        return []
    for other in sorted(asks.get(start, ())):
        if circle := _circle_from(other, asks, [*path, start], done):
            return circle
    done.add(start)
    return []
