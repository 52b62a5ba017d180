"""One execution from start to verdict: the world is built, arm or hand tries, a film is drawn."""

from __future__ import annotations

from contextlib import AbstractContextManager

import numpy as np
from numpy.typing import NDArray

from services.execution.arm import MAX_OPENING, Arm
from services.execution.arm_trial import ArmTrial
from services.execution.body import RigidBody, rigid_body
from services.execution.bullet import SOLVER_ITERATIONS, Bullet, physics
from services.execution.checks import ARMED
from services.execution.film import film
from services.execution.flying_cup import FlyingCup
from services.execution.flying_hand import FlyingHand
from services.execution.hand import lowest_point
from services.execution.hand_trial import HandTrial
from services.execution.motion import motion_fields
from services.execution.outcome import Verdict, inside_table, too_wide
from services.execution.placement import PREGRASP_DISTANCE, shifted
from services.execution.recording import STEPS_PER_SAMPLE, Recorder, Recording
from services.execution.scene import Scene, scene_from_request
from services.execution.waypoints import approach
from services.execution.world import World
from shared.geometry.se3 import inverse, transform_points
from shared.schemas.execution import ExecuteRequest, ExecuteResponse
from shared.schemas.gripper import ParallelGripper, SuctionGripper

Array = NDArray[np.float64]

OPENING_MARGIN = 0.01
"""The fingers open this much wider than the grasp needs, metres."""
TABLE_TOLERANCE = 0.005
"""A grasp this deep in the table is raised to its surface: planes are not known better."""
TABLE_CLEARANCE = 0.001
BRISK_ITERATIONS = 50
BRISK_PACE = 2.0
PROPPED = "; the object, which would not stand by itself, was propped up until it was gripped"


def warm_up() -> None:
    """Load the robot once, so that its files are read and the first request is fast."""
    with physics() as bullet:
        Arm(bullet)


def execute(request: ExecuteRequest, gripper: ParallelGripper | SuctionGripper) -> ExecuteResponse:
    """Replay a checked request in a fresh world and say what happened.

    Raises
    ------
    DegenerateCloud, InvalidInput
        The object has no volume, or lies below the plane.
    """
    if isinstance(gripper, ParallelGripper) and request.width > gripper.max_opening:
        return _refused(too_wide(request.width, gripper.name, gripper.max_opening))
    scene = scene_from_request(request)
    if request.actor == "hand" or gripper.name != ARMED or isinstance(gripper, SuctionGripper):
        return _by_hand(request, scene, gripper)
    return _by_arm(request, scene)


def _by_arm(request: ExecuteRequest, scene: Scene) -> ExecuteResponse:
    """Replay a request with the whole arm."""
    opening = min(scene.width + OPENING_MARGIN, MAX_OPENING)
    grasp = scene.world_from_grasp
    pregrasp = shifted(grasp, -PREGRASP_DISTANCE * grasp[:3, 2])
    lowest, where = min(
        (lowest_point(grasp, opening), "grasp"), (lowest_point(pregrasp, opening), "pregrasp")
    )
    if lowest < -TABLE_TOLERANCE:
        return _refused(inside_table(where, -lowest))
    raised = shifted(grasp, np.array([0.0, 0.0, max(0.0, TABLE_CLEARANCE - lowest)]))
    body = rigid_body(scene.parts, request.mass)
    with _world_of(request) as bullet:
        world = World(bullet, body)
        world.settle()
        arm = Arm(bullet)
        recorders = _Recorders(request, world, arm)
        trial = ArmTrial(world, arm, raised, opening, request.strict, recorders.all, scene.side)
        answer = _answer(request, world, trial)
        recording = recorders.of_film()
        answer = _with_motion(answer, request, scene, body, recorders, arm)
    return _filmed(answer, request, scene, body, recording, None)


def _by_hand(
    request: ExecuteRequest, scene: Scene, gripper: ParallelGripper | SuctionGripper
) -> ExecuteResponse:
    """Replay a request with the gripper alone."""
    grasp, body = scene.world_from_grasp, rigid_body(scene.parts, request.mass)
    start = approach(grasp).start
    with _world_of(request) as bullet:
        world = World(bullet, body)
        world.settle()
        hand: FlyingHand | FlyingCup
        if isinstance(gripper, SuctionGripper):
            hand = FlyingCup(bullet, gripper, start, _triangles(request, scene, body))
        else:
            opening = min(scene.width + OPENING_MARGIN, gripper.max_opening)
            hand = FlyingHand(bullet, gripper, start, opening)
        recorders = _Recorders(request, world, hand)
        pace = BRISK_PACE if request.brisk else 1.0
        trial = HandTrial(world, hand, grasp, request.strict, recorders.all, scene.side, pace)
        answer = _answer(request, world, trial)
        recording = recorders.of_film()
        answer = _with_motion(answer, request, scene, body, recorders, None)
    return _filmed(answer, request, scene, body, recording, gripper)


def _world_of(request: ExecuteRequest) -> AbstractContextManager[Bullet]:
    return physics(BRISK_ITERATIONS if request.brisk else SOLVER_ITERATIONS)


def _answer(request: ExecuteRequest, world: World, trial: ArmTrial | HandTrial) -> ExecuteResponse:
    """Have the trial carried out and return its answer."""
    propped = world.propped
    verdict, rise = trial.verdict(), trial.rise
    lifted = trial.lifted
    if not np.isfinite(world.rise()):
        verdict = Verdict("pushed_away", "the object flew off: its contacts diverged")
        lifted, rise = False, 0.0
    return ExecuteResponse(
        success=verdict.outcome == ("held" if request.strict else "lifted"),
        lifted=lifted,
        outcome=verdict.outcome,
        message=verdict.message + (PROPPED if propped else ""),
        lift_height=round(rise, 4),
        phases=tuple(trial.phases),
    )


class _Recorders:
    """Who watches a trial: for the film, for the numbers, as the request wants."""

    def __init__(
        self, request: ExecuteRequest, world: World, actor: Arm | FlyingHand | FlyingCup
    ) -> None:
        self._film = Recorder(world, actor) if request.animate else None
        self._motion = Recorder(world, actor, STEPS_PER_SAMPLE) if request.motion else None
        self.all = tuple(each for each in (self._film, self._motion) if each is not None)

    def of_film(self) -> Recording | None:
        """Return what the film shows; None where none is wanted or nothing moved."""
        return self._film.recording() if self._film is not None else None

    def of_motion(self) -> Recording | None:
        """Return what the answer holds as numbers; None likewise."""
        return self._motion.recording() if self._motion is not None else None


def _with_motion(
    answer: ExecuteResponse,
    request: ExecuteRequest,
    scene: Scene,
    body: RigidBody,
    recorders: _Recorders,
    arm: Arm | None,
) -> ExecuteResponse:
    """Return the answer with its motion, where one was recorded."""
    recording = recorders.of_motion()
    if recording is None:
        return answer
    return answer.model_copy(update=motion_fields(request, scene, body, recording, arm))


def _filmed(
    answer: ExecuteResponse,
    request: ExecuteRequest,
    scene: Scene,
    body: RigidBody,
    recording: Recording | None,
    gripper: ParallelGripper | SuctionGripper | None,
) -> ExecuteResponse:
    """Return the answer with its film, where something was recorded."""
    if recording is None:
        return answer
    animation = film(request, scene, body, recording, answer.outcome, gripper)
    return answer.model_copy(update={"animation": animation})


def _triangles(request: ExecuteRequest, scene: Scene, body: RigidBody) -> Array:
    """Return the object's surface (T, 3, 3) in the body's frame: the mesh, or the parts."""
    if request.vertices is None or request.faces is None:
        return np.concatenate([part.vertices[part.faces] for part in body.parts])
    body_from_mesh = inverse(body.world_from_body) @ scene.world_from_mesh
    return np.asarray(transform_points(body_from_mesh, request.vertices)[request.faces])


def _refused(verdict: Verdict) -> ExecuteResponse:
    """Return the answer to a grasp that is not worth simulating."""
    return ExecuteResponse(
        success=False,
        lifted=False,
        outcome=verdict.outcome,
        message=verdict.message,
        lift_height=0.0,
        phases=(),
    )
