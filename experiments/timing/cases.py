"""Which requests are timed."""

from __future__ import annotations

from dataclasses import dataclass

from experiments.framework import ShownView, ViewSet
from experiments.framework.views import load
from shared.errors import InvalidInput

PAIRS = (("handover", "spatula"), ("handover", "bottle"), ("hammering", "hammer"))
"""What the thesis measures: task and class (6.5.1)."""


@dataclass(frozen=True)
class Case:
    """A view and the task that it is asked for."""

    view: ShownView
    task: str
    class_name: str


def cases_of(views: ViewSet, per_pair: int) -> list[Case]:
    """Return the thesis's pairs; of views whose classes are unknown, every object's first task.

    Raises
    ------
    InvalidInput
        There are no views.
    """
    cases: list[Case] = []
    for task, class_name in PAIRS:
        chosen = _spread(of_class(views, class_name), per_pair)
        cases += [Case(load(file), task, class_name) for file in chosen.files]
    if not cases:
        loaded = [(file.object_name, load(file)) for file in views.files[: per_pair * len(PAIRS)]]
        cases = [Case(view, view.tasks[0], name) for name, view in loaded if view.tasks]
    if not cases:
        raise InvalidInput("there are no views to time requests with")
    return cases


def all_cases(views: ViewSet, per_object: int) -> list[Case]:
    """Return every task of some views of each object."""
    return [
        Case(view, task, views.thing(file).class_name)
        for file in views.limited(per_object).files
        for view in [load(file)]
        for task in view.tasks
    ]


def of_class(views: ViewSet, class_name: str) -> ViewSet:
    """Return the views of a class of objects."""
    return views.only(lambda file: views.thing(file).class_name == class_name)


def _spread(views: ViewSet, count: int) -> ViewSet:
    """Return `count` views, as evenly as can be over the objects: all first views come first."""
    order = sorted(views.files, key=lambda file: (file.number, file.object_name))
    kept = set(order[:count])
    return views.only(kept.__contains__)
