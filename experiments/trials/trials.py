"""One scene's grasps, tried in physics, as they are on disk.

A trial's file holds what the grasp proposal is asked with, and what came of its grasps:

    points (N, 3) float32     the object as perceived, camera frame, metres
    regions (Q, N) bool       where grasps were wanted, for each question
    plane (4,)                support plane: unit normal, offset; NaN where none was seen
    up (3,)                   against gravity, as perceived
    superquadrics (P, 12)     recovered from the object, as in the answer
    grippers (Q,) str         for each question
    question (G,) int         of each grasp
    grasps (G, 9)             x y z qx qy qz qw width score, camera frame
    rank (G,) int             in the answer, 0 the best
    moved (G,) bool           moved by a few millimetres and degrees from where the answer has it
    lifted, held (G,) bool    lifted off the table; kept when shaken and tilted, too
    outcome (G,) str          of POST /execute
    rehearsed (G, 2) str      the same on what may be believed of it (`BELIEVED` of
                              shared.schemas.execution); empty where it came to no end or
                              was not wanted
    object_class () str, number () int, view () int, sigma_at_1m () float
    mass () float             kg
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.dataset.randomness import generator
from experiments.framework.asking import NOT_THE_VIEW
from experiments.framework.replay import free_hand
from experiments.trials.candidates import Tried, spread
from experiments.trials.scenes import Scene
from shared.client import GraspResult, Sparge
from shared.errors import DeadlineExceeded, InvalidInput, SpargeError
from shared.rehearsal import rehearsals
from shared.schemas.execution import BELIEVED, ExecuteRequest, ExecuteResponse
from shared.schemas.primitive import superquadric_rows

Array = NDArray[np.float64]
Judge = Callable[[ExecuteRequest], ExecuteResponse]

HELD = "held"
MAX_GRASPS = 100
USUAL_GRIPPER, USUAL = "panda", 0.7
"""The gripper that most questions are asked with, and their share."""


def try_out(
    sparge: Sparge,
    judge: Judge,
    scene: Scene,
    *,
    blind: Sequence[str],
    grippers: Sequence[str],
    each: int,
    seed: int,
    rehearse: bool = False,
) -> dict[str, NDArray[Any]] | None:
    """Return the arrays of a scene's trials; None where no question gets a grasp.

    One question is about a task of the object, the other about any part but those of one
    affordance.

    Parameters
    ----------
    sparge : Sparge
    judge : callable
        Executes a grasp.
    scene : Scene
    blind : sequence of str
        Names of tasks that each avoid one affordance and are content with any other part.
    grippers : sequence of str
        Parallel ones, by name.
    each : int
        Grasps that are tried for each question.
    seed : int
    rehearse : bool
        Try each grasp on what was recovered, too, which takes about as long again.

    Raises
    ------
    SpargeError
        The backend is down or failed.
    """
    rng = generator(seed, f"trials with {scene.thing.name}", scene.view)
    asked: list[tuple[GraspResult, str, Tried]] = []
    task = str(rng.choice(scene.thing.tasks))
    for name in (task, str(rng.choice(blind))):
        gripper = USUAL_GRIPPER if rng.random() < USUAL else str(rng.choice(grippers))
        result = _ask(sparge, scene, name, gripper)
        if result is not None and len(result.grasps):
            asked.append((result, gripper, spread(result.grasps, each, rng)))
    if not asked:
        return None
    on_object = asked[0][0].point_primitive >= 0
    tried = [chosen for _, _, chosen in asked]
    grasps = np.concatenate([each.grasps for each in tried])
    question = np.repeat(np.arange(len(asked)), [len(each.rank) for each in tried])
    happened = [
        _judged(judge, execution(scene, row, asked[index][1]))
        for index, row in zip(question, grasps, strict=True)
    ]
    rehearsed = [
        [_rehearsed(judge, each) for each in _rehearsals(scene, row, *asked[index][:2])]
        if rehearse
        else [""] * len(BELIEVED)
        for index, row in zip(question, grasps, strict=True)
    ]
    done = np.array([each is not None for each in happened], dtype=np.bool_)
    answers = [each for each in happened if each is not None]
    if not answers:
        return None
    outcome = np.array([each.outcome for each in answers])
    seen = asked[0][0].answer.scene
    plane = (*seen.plane.normal, seen.plane.offset) if seen.plane else (np.nan,) * 4
    return {
        "points": scene.shown.points[on_object].astype(np.float32),
        "regions": np.array([result.point_region[on_object] for result, _, _ in asked]),
        "plane": np.array(plane),
        "up": np.array(seen.up),
        "superquadrics": superquadric_rows(asked[0][0].answer.primitives),
        "grippers": np.array([gripper for _, gripper, _ in asked]),
        "question": question[done],
        "grasps": grasps[done],
        "rank": np.concatenate([each.rank for each in tried])[done],
        "moved": np.concatenate([each.moved for each in tried])[done],
        "lifted": np.array([each.lifted for each in answers]),
        "held": outcome == HELD,
        "outcome": outcome,
        "rehearsed": np.array(rehearsed)[done],
        "object_class": np.array(scene.thing.class_name),
        "number": np.array(int(scene.thing.name.split("-")[-1])),
        "view": np.array(scene.view),
        "sigma_at_1m": np.array(scene.sigma_at_1m),
        "mass": np.array(scene.mass),
    }


def execution(scene: Scene, grasp: Array, gripper: str) -> ExecuteRequest:
    """Return the request to try a grasp (9,) on the object as it really is, with a free hand."""
    return free_hand(scene.shown, scene.vertices, scene.faces, grasp, gripper, scene.mass)


def _rehearsals(
    scene: Scene, grasp: Array, result: GraspResult, gripper: str
) -> list[ExecuteRequest]:
    """Return the requests to try a grasp (9,) on what was recovered of the object."""
    seen = result.answer.scene
    return rehearsals(
        grasp,
        superquadric_rows(result.answer.primitives).tolist(),
        points=scene.shown.points[result.point_primitive >= 0],
        viewpoint=(0.0, 0.0, 0.0),
        plane=seen.plane,
        up=seen.up,
        gripper=gripper,
    )


def _judged(judge: Judge, request: ExecuteRequest) -> ExecuteResponse | None:
    """Return what came of a grasp; None where the simulation came to no end in time."""
    try:
        return judge(request)
    except DeadlineExceeded:
        return None


def _rehearsed(judge: Judge, request: ExecuteRequest) -> str:
    """Return what came of a rehearsal; empty where it came to no end or has no object."""
    try:
        return judge(request).outcome
    except (DeadlineExceeded, InvalidInput):
        return ""


def _ask(sparge: Sparge, scene: Scene, task: str, gripper: str) -> GraspResult | None:
    try:
        return sparge.grasp(
            scene.shown.arrays(),
            task,
            reasoning="v2",
            gripper=gripper,
            max_grasps=MAX_GRASPS,
            explain=False,
            rehearsal="never",
        )
    except NOT_THE_VIEW:
        raise
    except SpargeError:  # this view cannot be answered
        return None
