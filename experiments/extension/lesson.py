"""Asking knives and scissors at every stage of the lesson."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from experiments.framework import Asked, Context, ShownView, ask
from experiments.framework.asking import VERSIONS, Source, each_view
from shared.client import Sparge
from shared.errors import NotFound
from shared.schemas.route import Nothing
from shared.schemas.task import LIST_TASKS, Task, Version

CUTTING = "cutting"


BEFORE, AFTER, REMOVED, BUILT_IN = "before", "after", "removed again", "built in"


@dataclass(frozen=True)
class Taught:
    """An answer about a view at one stage of the lesson."""

    stage: str
    asked: Asked
    region: bytes
    """The points of the region, to compare answers."""


def known_task(sparge: Sparge, name: str) -> Task:
    """Return a task of the backend.

    Raises
    ------
    NotFound
        It does not know it.
    """
    for task in sparge.call(LIST_TASKS, Nothing()).tasks:
        if task.name == name:
            return task
    raise NotFound(f"the backend does not know the task {name!r}")


def ask_all(context: Context, stages: Mapping[str, str]) -> list[Taught]:
    """Return the answers about every view of a thing for cutting, asked for each stage's task."""

    def one(source: Source, view: ShownView) -> list[Taught]:
        return [
            _ask_one(context.sparge, source, view, stage, task, version)
            for stage, task in stages.items()
            for version in VERSIONS
        ]

    return each_view(
        one,
        [each.serving(CUTTING) for each in context.sets],
        workers=context.workers,
        console=context.console,
        describe=f"cutting, {' and '.join(stages)}",
    )


def _ask_one(
    sparge: Sparge, source: Source, view: ShownView, stage: str, task: str, version: Version
) -> Taught:
    asked, result = ask(
        sparge, source, view, task, version, truth_task=CUTTING, max_grasps=1, explain=False
    )
    region = b"" if result is None else np.packbits(result.point_region).tobytes()
    return Taught(stage, asked, region)
