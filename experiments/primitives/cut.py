"""Asking for the parts of a view by each method, and what they are worth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from experiments.framework import ShownView
from experiments.framework.asking import NOT_THE_VIEW, Source
from experiments.framework.scoring import GOOD_IOU
from experiments.primitives.match import match
from experiments.primitives.truth import TruePart
from shared.client import GraspResult, Sparge
from shared.errors import SpargeError
from shared.schemas.primitive import PRESETS, Method

Array = NDArray[np.float64]

METHODS: tuple[Method, ...] = ("parts", "ems")
PUBLISHED = PRESETS["simulation"]
"""What `ems` is asked with: Table A.1, the column for simulation."""
VERY_GOOD_IOU = 0.85


@dataclass(frozen=True)
class RegionCut:
    """A labelled region and the parts that were found.

    Attributes
    ----------
    task : str
    single, union : float
        Intersection over union of the best part, and of the best set of parts.
    extents : tuple of float, or None
        log(found / true) of the shortest, middle and longest full extent of the best
        part, where it overlaps by `GOOD_IOU` and the true ones are known.
    shape_is_right : bool or None
        Its shape has the right name; None as for extents, or where no name is clear.
    """

    task: str
    single: float
    union: float
    extents: tuple[float, float, float] | None = None
    shape_is_right: bool | None = None


@dataclass(frozen=True)
class Cut:
    """The parts of one view by one method.

    Attributes
    ----------
    source, thing, class_name, view : str
        The set of views, the object, its class, the file.
    method : str
        That was asked for.
    answered : str
        That the answer says was used; empty for an error.
    regions : tuple of RegionCut
        One for each task of the object.
    parts, points : int
        How many were found, and in how many points that perception took for the object.
    assigned : float
        Share of the object's labelled points that are some part's.
    seconds : float or None
        The stage as the gateway measured it; None for an error.
    code : str
        Of the error that was answered instead.
    """

    source: str
    thing: str
    class_name: str
    view: str
    method: Method
    answered: str
    regions: tuple[RegionCut, ...]
    parts: int = 0
    points: int = 0
    assigned: float = 0.0
    seconds: float | None = None
    code: str = ""

    @property
    def worst(self) -> RegionCut:
        """The region whose best part overlaps it least."""
        return min(self.regions, key=lambda region: region.single)

    def records(self) -> list[dict[str, str]]:
        """Return one line of a CSV file for each region."""
        return [
            {
                "source": self.source,
                "object": self.thing,
                "class": self.class_name,
                "view": self.view,
                "method": self.method,
                "answered": self.answered,
                "parts": str(self.parts),
                "points": str(self.points),
                "assigned": f"{self.assigned:.4f}",
                "ms": "" if self.seconds is None else f"{1e3 * self.seconds:.2f}",
                "code": self.code,
                "task": region.task,
                "single_iou": f"{region.single:.6f}",
                "union_iou": f"{region.union:.6f}",
                **{
                    f"log_error_{name}": f"{error:.6f}"
                    for name, error in zip(
                        ("shortest", "middle", "longest"), region.extents or (), strict=False
                    )
                },
                "shape_is_right": ""
                if region.shape_is_right is None
                else str(region.shape_is_right).lower(),
            }
            for region in self.regions
        ]


def ask_parts(sparge: Sparge, view: ShownView, method: Method) -> GraspResult:
    """Ask for the parts of a view; no grasps, and any task, as all have the same parts.

    Raises
    ------
    SpargeError
        What the backend answered with.
    """
    parameters = {"recovery": PUBLISHED} if method == "ems" else {}
    return sparge.grasp(
        view.arrays(), view.tasks[0], method=method, max_grasps=0, explain=False, **parameters
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
