"""What a set of parameters costs: asked over POST /grasp, for every view."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from experiments.catalogue import CATALOGUE, build
from experiments.dataset import ViewFile
from experiments.framework.scoring import GOOD_IOU, score_region
from experiments.framework.views import load
from experiments.tuning.cost import ViewCost, view_cost
from experiments.tuning.expected import ExpectedPrimitive, expected_primitives
from shared.client import Sparge
from shared.errors import DegenerateCloud, EmptyCloud, InvalidInput
from shared.geometry.se3 import inverse, transform_points
from shared.schemas.primitive import EmsParameters

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TuningView:
    """An object's visible points, and what should be recovered from them.

    Attributes
    ----------
    thing, number : str, int
        The object and which view of it.
    points : (N, 3) array
        In the camera's frame, metres.
    object_from_camera : (4, 4) array
    expected : tuple of ExpectedPrimitive
    task : str
        The first task of the object.
    region : (N,) bool array
        The points to hold for it.
    """

    thing: str
    number: int
    points: Array
    object_from_camera: Array
    expected: tuple[ExpectedPrimitive, ...]
    task: str
    region: NDArray[np.bool_]


@dataclass(frozen=True)
class ViewOutcome:
    """What came of one view.

    Attributes
    ----------
    view : TuningView
    recovered : int
        How many primitives.
    cost : ViewCost
    good : bool
        The region for the object's task is right: IoU of at least 0.7.
    """

    view: TuningView
    recovered: int
    cost: ViewCost
    good: bool


@dataclass(frozen=True)
class Evaluation:
    """What came of all views."""

    outcomes: tuple[ViewOutcome, ...]

    @property
    def cost(self) -> float:
        """Mean cost of the views: what is minimised."""
        return float(np.mean([each.cost.total for each in self.outcomes]))


def tuning_views(files: Sequence[ViewFile]) -> tuple[TuningView, ...]:
    """Return views of objects of the catalogue with what is expected of them.

    Raises
    ------
    InvalidInput
        An object is not in the catalogue: nobody knows its parts.
    """
    unknown = sorted({each.object_name for each in files} - set(CATALOGUE))
    if unknown:
        raise InvalidInput(
            f"the expected primitives of {', '.join(unknown)} are not known; "
            "parameters are tuned on views of the catalogue"
        )
    expected = {
        name: expected_primitives(build(name))
        for name in dict.fromkeys(each.object_name for each in files)
    }
    found = []
    for file in files:
        shown = load(file)
        task = shown.tasks[0]
        points, region = shown.object_points, shown.truth(task)
        finite = np.isfinite(points).all(axis=1)
        found.append(
            TuningView(
                thing=file.object_name,
                number=file.number,
                points=points[finite],
                object_from_camera=inverse(shown.view.camera_from_object),
                expected=expected[file.object_name],
                task=task,
                region=region[finite],
            )
        )
    return tuple(found)


class Evaluator:
    """Asks a backend about views, several at a time.

    Parameters
    ----------
    sparge : Sparge
    pool : ThreadPoolExecutor
    seed : int
        Sent with every question.
    """

    def __init__(self, sparge: Sparge, pool: ThreadPoolExecutor, seed: int) -> None:
        self._sparge = sparge
        self._pool = pool
        self._seed = seed

    def evaluate(self, parameters: EmsParameters, views: Sequence[TuningView]) -> Evaluation:
        """Return what `parameters` make of the views.

        Raises
        ------
        SpargeError
            The backend is down, failed or came to no end.
        """
        return Evaluation(tuple(self._pool.map(lambda view: self._ask(view, parameters), views)))

    def _ask(self, view: TuningView, parameters: EmsParameters) -> ViewOutcome:
        try:
            result = self._sparge.grasp(
                {"points": view.points},
                view.task,
                input="object",
                max_grasps=0,
                explain=False,
                seed=self._seed,
                method="ems",
                recovery=parameters,
            )
        except (EmptyCloud, DegenerateCloud):  # too little to see: no primitive
            return ViewOutcome(view, 0, ViewCost(), good=False)
        primitives = result.answer.primitives
        places = np.array([each.superquadric.position for each in primitives]).reshape(-1, 3)
        return ViewOutcome(
            view,
            recovered=len(primitives),
            cost=view_cost(
                [each.full_extents for each in primitives],
                transform_points(view.object_from_camera, places),
                view.expected,
            ),
            good=result.answer.found
            and score_region(view.region, result.point_region).iou >= GOOD_IOU,
        )
