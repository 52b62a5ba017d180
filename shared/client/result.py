"""What comes back: the answer, its arrays, and the grasps as poses with named frames."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from shared.client.headline import headline
from shared.errors import NotFound
from shared.geometry.transform import Transform
from shared.schemas.answer import Grasp, GraspAnswer
from shared.schemas.execution import ExecuteRequest
from shared.schemas.grasp import Pose
from shared.schemas.task import Reason


@dataclass(frozen=True)
class RankedGrasp:
    """A grasp of an answer.

    A grasp's frame lies midway between the finger tips: +z approaches, +y closes.

    Attributes
    ----------
    rank : int
        0 is the best of the answer.
    pose, pregrasp, retreat : Transform
        From the view's frame, as in `camera_from_grasp`: where the gripper closes, where it
        starts the straight approach along +z, and where it lifts the object to.
    width : float
        Opening that the grasp needs, metres.
    score : float
        Probability in [0, 1] that the object is lifted.
    """

    rank: int
    pose: Transform
    pregrasp: Transform
    retreat: Transform
    width: float
    score: float

    @classmethod
    def of(cls, rank: int, grasp: Grasp, frame_id: str) -> RankedGrasp:
        """Return a grasp of an answer in the frame `frame_id`."""

        def placed(name: str, pose: Pose) -> Transform:
            return Transform.from_pose(frame_id, name, pose.position, pose.quaternion)

        return cls(
            rank,
            placed("grasp", grasp.pose),
            placed("pregrasp", grasp.pregrasp),
            placed("retreat", grasp.retreat),
            grasp.width,
            grasp.score,
        )


@dataclass(frozen=True, repr=False)
class GraspResult:
    """The answer to POST /grasp and its arrays.

    Attributes
    ----------
    answer : GraspAnswer
        Region, primitives, grasps, explanation, timings.
    point_primitive : (N,) int16 array
        Id of the primitive of every INPUT point, -1: none. A depth image has H*W
        points, row-major.
    point_region : (N,) bool array
        Whether the input point is part of what to hold.
    grasps : (G, 9) array
        x y z qx qy qz qw width score, best first.
    """

    answer: GraspAnswer
    point_primitive: NDArray[np.int16]
    point_region: NDArray[np.bool_]
    grasps: NDArray[np.float64]

    @property
    def found(self) -> bool:
        """A part to hold was found; there may still be no grasp for it."""
        return self.answer.found

    @property
    def reason(self) -> Reason | None:
        """Why there is no region or no grasp; None where there is one."""
        return self.answer.reason

    @property
    def why(self) -> str:
        """The reasoning in words; empty where `explain` was false."""
        return self.answer.explanation.text if self.answer.explanation else ""

    @cached_property
    def ranked(self) -> tuple[RankedGrasp, ...]:
        """All grasps, best first."""
        return tuple(
            RankedGrasp.of(rank, grasp, self.answer.frame_id)
            for rank, grasp in enumerate(self.answer.grasps)
        )

    @property
    def best(self) -> RankedGrasp | None:
        """The best grasp; None where there is none, and `reason` says why."""
        return self.ranked[0] if self.ranked else None

    def execution(
        self,
        rank: int = 0,
        *,
        strict: bool = False,
        animate: bool = False,
        motion: bool = False,
        seed: int = 0,
    ) -> ExecuteRequest:
        """Return the request to try a grasp in simulation, on the parts that were recovered.

        Parameters
        ----------
        rank : int
            Which grasp, 0 is the best.
        strict, animate, motion, seed
            As in `ExecuteRequest`: shake and tilt after the lift, film it, give what moved as
            arrays.

        Raises
        ------
        NotFound
            The answer has no such grasp.
        """
        if not 0 <= rank < len(self.answer.grasps):
            raise NotFound(
                f"there is no grasp {rank}: the answer has {len(self.answer.grasps)}",
                found=rank,
                grasps=len(self.answer.grasps),
            )
        grasp, scene = self.answer.grasps[rank], self.answer.scene
        return ExecuteRequest(
            pose=grasp.pose,
            width=grasp.width,
            primitives=tuple(each.parameters for each in self.answer.primitives),
            plane=scene.plane,
            up=scene.up,
            gripper=self.answer.gripper,
            strict=strict,
            animate=animate,
            motion=motion,
            seed=seed,
        )

    def __repr__(self) -> str:
        held = self.ranked
        grasps = f"{len(held)} grasps, best score {held[0].score:.2f}" if held else "no grasp"
        why = f" ({self.reason.code})" if self.reason else ""
        return f"<GraspResult {headline(self.answer)}; {grasps}{why}, frame {self.answer.frame_id}>"
