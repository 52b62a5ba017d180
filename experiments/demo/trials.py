"""One trial: ask where to hold, let the arm do it, see what comes of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from experiments.demo.scenes import Scene
from experiments.framework.replay import Replays
from experiments.framework.scoring import RegionScore, holds, score_region
from shared.client import GraspResult, Sparge
from shared.client.trying import until_it_moves
from shared.schemas.execution import ExecuteRequest, ExecuteResponse
from shared.schemas.grasp import Pose
from shared.schemas.task import Version

MAX_GRASPS = 5
"""The arm tries the next best grasp while it finds no way to the one before."""


@dataclass(frozen=True)
class Trial:
    """What came of one question.

    Attributes
    ----------
    pose, task, version : str
    number : int
        Which view.
    yaw_deg : float
        The object's turn about the vertical.
    found : bool
        A part to hold was named.
    reason : str
        Why there is no region, or no grasp; empty if there is one.
    score : RegionScore or None
        Of the region that was found.
    tried : int
        How many grasps were given to the arm, best first.
    in_region : bool
        The last of them holds the labelled region.
    executed : ExecuteResponse or None
        What came of that one; without the film.
    film : bytes
        An animated GIF; empty when nothing moved.
    """

    pose: str
    task: str
    version: Version
    number: int
    yaw_deg: float
    found: bool
    reason: str = ""
    score: RegionScore | None = None
    tried: int = 0
    in_region: bool = False
    executed: ExecuteResponse | None = None
    film: bytes = field(default=b"", repr=False)

    @property
    def good(self) -> bool:
        """The region overlaps the labelled one well."""
        return self.score is not None and self.score.good

    @property
    def lifted(self) -> bool:
        return self.executed is not None and self.executed.success

    @property
    def succeeded(self) -> bool:
        """The object was lifted, and by the right part."""
        return self.lifted and self.in_region

    @property
    def outcome(self) -> str:
        """What happened, or why nothing did, in few words."""
        if self.executed is not None:
            return self.executed.outcome.replace("_", " ")
        return f"no {'grasp' if self.found else 'region'}: {self.reason.replace('_', ' ')}"

    @property
    def name(self) -> str:
        """Of the trial's file."""
        return f"{self.pose}-{self.task}-{self.version}-{self.number}"

    def record(self) -> Mapping[str, str]:
        """Return it as a line of a CSV file."""
        score, executed = self.score, self.executed
        return {
            "pose": self.pose,
            "task": self.task,
            "reasoning": self.version,
            "view": str(self.number),
            "yaw_deg": f"{self.yaw_deg:.1f}",
            "found": str(self.found).lower(),
            "reason": self.reason,
            "iou": f"{score.iou:.6f}" if score else "",
            "precision": f"{score.precision:.6f}" if score else "",
            "recall": f"{score.recall:.6f}" if score else "",
            "good": str(self.good).lower(),
            "grasps_tried": str(self.tried),
            "grasp_in_region": str(self.in_region).lower(),
            "outcome": self.outcome,
            "lifted": str(self.lifted).lower(),
            "lift_height_m": f"{executed.lift_height:.4f}" if executed else "",
            "message": executed.message if executed else "",
        }


def attempt(sparge: Sparge, arm: Replays, scene: Scene, task: str, version: Version) -> Trial:
    """Ask for the best grasps and execute the first that the arm finds a way to.

    Raises
    ------
    SpargeError
        What the backend answered with: the scene is sound, so nothing is measured.
    """
    result = sparge.grasp(
        scene.shown.arrays(), task, reasoning=version, max_grasps=MAX_GRASPS, explain=False
    )
    answer = result.answer
    trial = Trial(
        scene.pose,
        task,
        version,
        scene.number,
        scene.yaw_deg,
        answer.found,
        answer.reason.code if answer.reason else "",
    )
    if answer.found:
        trial = replace(
            trial,
            score=score_region(scene.shown.truth(task), result.point_region[scene.shown.on_object]),
        )
    return _executed(arm, scene, trial, result)


def _executed(arm: Replays, scene: Scene, trial: Trial, result: GraspResult) -> Trial:
    """Return the trial with what the arm made of its grasps, best first."""
    tried = until_it_moves(
        arm.execute, (execution(scene, trial.task, grasp) for grasp in result.grasps)
    )
    if not tried:
        return trial
    grasp, film = result.grasps[len(tried) - 1], tried[-1].animation
    return replace(
        trial,
        tried=len(tried),
        in_region=holds(grasp[:3], scene.shown.object_points, scene.shown.truth(trial.task)),
        executed=tried[-1].model_copy(update={"animation": None}),
        film=film.tobytes() if film is not None else b"",
    )


def execution(scene: Scene, task: str, grasp: NDArray[np.float64]) -> ExecuteRequest:
    """Return the request to execute a grasp (9,) on the object as it really is, filmed.

    The table is where the object's true mesh touches it, not where perception saw it.
    """
    x, y, z, qx, qy, qz, qw, width, _ = map(float, grasp)
    return ExecuteRequest(
        pose=Pose(position=(x, y, z), quaternion=(qx, qy, qz, qw)),
        width=width,
        vertices=scene.vertices,
        faces=scene.thing.surface.faces,
        up=scene.up,
        animate=True,
        highlight=scene.faces_of(task),
    )
