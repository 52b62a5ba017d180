"""Asking for the parts of a view by each method, and what they are worth."""

from __future__ import annotations

import numpy as np

from experiments.framework import ShownView
from experiments.framework.asking import NOT_THE_VIEW, Source
from experiments.framework.scoring import GOOD_IOU
from experiments.primitives.match import match
from experiments.primitives.model import Cut, RegionCut
from experiments.primitives.truth import TruePart
from shared.client import GraspResult, Sparge
from shared.errors import SpargeError
from shared.schemas.primitive import PRESETS, Method

PUBLISHED = PRESETS["simulation"]
"""What `ems` is asked with: Table A.1, the column for simulation."""


def ask_parts(sparge: Sparge, view: ShownView, method: Method) -> GraspResult:
    """Ask for the parts of a view; no grasps, and any task, as all have the same parts.

    Raises
    ------
    SpargeError
        What the backend answered with.
    """
    return sparge.grasp(
        view.arrays(),
        view.tasks[0],
        method=method,
        recovery=PUBLISHED if method == "ems" else None,
        max_grasps=0,
        explain=False,
    )


def cut(
    sparge: Sparge,
    source: Source,
    view: ShownView,
    method: Method,
    truths: dict[str, TruePart],
) -> Cut:
    """Return what a method makes of a view.

    Parameters
    ----------
    sparge : Sparge
    source : Source
    view : ShownView
    method : str
    truths : dict
        The true part of each task's region, as far as it is known.

    Raises
    ------
    SpargeError
        The backend is down, failed or came to no end.
    """
    tasks = [task for task in view.tasks if view.truth(task).any()]
    where = (source.set_name, source.file.object_name, source.thing.class_name)
    number = str(source.file.number)
    try:
        result = ask_parts(sparge, view, method)
    except NOT_THE_VIEW:
        raise
    except SpargeError as error:
        nothing = tuple(RegionCut(task, 0.0, 0.0) for task in tasks)
        return Cut(*where, number, method, "", nothing, code=error.code)
    scene = result.answer.scene
    return Cut(
        *where,
        number,
        method,
        scene.method,
        tuple(_region(view, result, task, truths.get(task)) for task in tasks),
        parts=len(result.answer.primitives),
        points=scene.object_points,
        assigned=float((result.point_primitive[view.on_object] >= 0).mean()),
        seconds=1e-3 * result.answer.timings_ms["primitive_recovery"],
    )


def _region(view: ShownView, result: GraspResult, task: str, truth: TruePart | None) -> RegionCut:
    found = match(result.point_primitive[view.on_object], view.truth(task))
    if truth is None or found.part is None or found.single < GOOD_IOU:
        return RegionCut(task, found.single, found.union)
    part = next(each for each in result.answer.primitives if each.id == found.part)
    short, middle, long = np.log(np.sort(part.full_extents) / truth.extents).tolist()
    return RegionCut(
        task,
        found.single,
        found.union,
        (short, middle, long),
        None if truth.shape is None else part.shape_class == truth.shape,
    )
