"""The motion as numbers: it is what happened, in the frame of the request."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from services.execution.arm import Arm
from services.execution.body import rigid_body
from services.execution.bullet import physics
from services.execution.flying_hand import FlyingHand
from services.execution.hand_trial import HandTrial
from services.execution.motion import pose_rows
from services.execution.recording import (
    STEPS_PER_FRAME,
    STEPS_PER_SAMPLE,
    Recorder,
    Recording,
)
from services.execution.scene import scene_from_request
from services.execution.waypoints import approach
from services.execution.world import SETTLE_S, World
from shared.geometry.se3 import inverse, matrix_from_pose, pose_matrix, transform_points
from shared.grippers import load_grippers
from shared.schemas.execution import ExecuteRequest, ExecuteResponse
from shared.schemas.grasp import Pose
from shared.schemas.gripper import ParallelGripper
from shared.wire import JSON, NPZ, decode, encode
from tests.services.execution.scenes import (
    CAMERA_FROM_WORLD,
    STANDING_SUPERQUADRIC,
    box,
    cylinder,
    execute,
    from_above,
    from_side,
    request,
)

Array = NDArray[np.float64]

SIDE = request((0, 0, 0.09), from_side(), cylinder(), seen_from=CAMERA_FROM_WORLD, strict=True)
ASKED: dict[str, ExecuteRequest] = {
    "arm": SIDE,
    "hand": SIDE.model_copy(update={"gripper": "robotiq_2f85", "actor": "hand"}),
    "cup": request(
        (0, 0, 0.06),
        from_above(),
        box((0.05, 0.05, 0.03), (0, 0, 0.03)),
        width=0.0,
        gripper="onrobot_vgc10",
    ),
    "pushed": request(
        (0, 0, 0.045), from_above(), box((0.05, 0.05, 0.03), (0, 0, 0.03)), width=0.03
    ),
}
MOTION = {
    name: None if name != "motion_phases" else ()
    for name in ExecuteResponse.model_fields
    if name.startswith("motion_")
}


@cache
def moved(which: str) -> ExecuteResponse:
    return execute(ASKED[which].model_copy(update={"motion": True}))


def poses(rows: Array | None) -> list[Array]:
    assert rows is not None
    return [matrix_from_pose(row[:3], row[3:]) for row in rows]


@pytest.mark.parametrize("which", list(ASKED))
def test_the_outcome_is_the_same_with_and_without(which: str) -> None:
    alone = execute(ASKED[which])
    assert "motion_" not in alone.model_dump_json()
    assert moved(which).model_copy(update=MOTION) == alone


def test_a_recorder_sees_the_same_beside_another() -> None:
    def recorded(*paces: int) -> list[Recording | None]:
        scene = scene_from_request(ASKED["hand"])
        gripper = load_grippers()["robotiq_2f85"]
        assert isinstance(gripper, ParallelGripper)
        with physics() as bullet:
            world = World(bullet, rigid_body(scene.parts))
            world.settle()
            hand = FlyingHand(bullet, gripper, approach(scene.world_from_grasp).start, 0.07)
            recorders = [Recorder(world, hand, pace) for pace in paces]
            HandTrial(world, hand, scene.world_from_grasp, False, recorders).verdict()
            return [each.recording() for each in recorders]

    (film,), (beside, _) = recorded(STEPS_PER_FRAME), recorded(STEPS_PER_FRAME, STEPS_PER_SAMPLE)
    assert film is not None
    assert beside is not None
    for mine, its in zip(film.snapshots, beside.snapshots, strict=True):
        assert np.array_equal(mine.world_from_body, its.world_from_body)
        assert (mine.phase, mine.opening, mine.since_s) == (its.phase, its.opening, its.since_s)


@pytest.mark.parametrize("which", list(ASKED))
def test_moments_are_a_24th_of_a_second_apart_on_the_clock_of_the_phases(which: str) -> None:
    answer = moved(which)
    times = answer.motion_times
    assert times is not None
    assert times[0] == pytest.approx(SETTLE_S)
    assert np.diff(times)[:-1] == pytest.approx(1 / 24)
    assert 0 < np.diff(times)[-1] <= 1 / 24 + 1e-9
    for name in ("object", "hand", "opening"):
        assert len(getattr(answer, f"motion_{name}")) == len(times)
    assert len(answer.motion_phases) == len(times)
    over = {phase.name: phase.simulated_s for phase in answer.phases}
    assert times[-1] >= answer.phases[-1].simulated_s - 1e-9
    for name, time in zip(answer.motion_phases[:-1], times[:-1], strict=True):
        assert time < over.get(name, np.inf)
    assert list(dict.fromkeys(answer.motion_phases))[: len(over) - 1] == list(over)[1:]


@pytest.mark.parametrize("which", ["arm", "hand", "cup"])
def test_the_object_is_where_it_was_given_and_rises_as_far_as_the_answer_says(which: str) -> None:
    asked, answer = ASKED[which], moved(which)
    placed = poses(answer.motion_object)
    assert placed[0] == pytest.approx(np.eye(4), abs=0.004)  # it settles by a little
    assert asked.vertices is not None
    assert asked.up is not None
    lifted = [i for i, name in enumerate(answer.motion_phases) if name in ("lift", "hold")][-1]
    before, after = (
        transform_points(pose, asked.vertices).mean(axis=0) @ asked.up
        for pose in (placed[0], placed[lifted])
    )
    assert after - before == pytest.approx(answer.lift_height, abs=0.01)


@pytest.mark.parametrize("which", ["arm", "hand", "cup"])
def test_the_hand_comes_straight_to_the_grasp(which: str) -> None:
    asked, answer = ASKED[which], moved(which)
    goal = matrix_from_pose(asked.pose.position, asked.pose.quaternion)
    hands = poses(answer.motion_hand)
    closing = len(hands) - 1 - answer.motion_phases[::-1].index("close")
    start, end = (
        inverse(goal) @ hands[i] for i in (answer.motion_phases.index("approach"), closing)
    )
    assert start[:3, 3] == pytest.approx([0, 0, -0.10], abs=0.006)
    assert end[:3, 3] == pytest.approx([0, 0, 0], abs=0.006)
    assert end[:3, :3] == pytest.approx(np.eye(3), abs=0.03)
    assert answer.motion_opening is not None
    opening = answer.motion_opening
    if which == "cup":
        assert not opening.any()
    else:
        assert opening[answer.motion_phases.index("close") - 1] == pytest.approx(
            asked.width + 0.01, abs=0.002
        )
        assert opening[-1] == pytest.approx(0.06, abs=0.004)  # the cylinder is between the pads


def test_while_it_is_held_the_object_moves_with_the_hand() -> None:
    for which in ("arm", "hand", "cup"):
        answer = moved(which)
        lifting = [i for i, name in enumerate(answer.motion_phases) if name in ("lift", "hold")]
        hands, objects = poses(answer.motion_hand), poses(answer.motion_object)
        grips = [inverse(hands[i]) @ objects[i] for i in lifting[2:]]
        for grip in grips:
            assert grip == pytest.approx(grips[0], abs=0.02)


def test_the_joints_hold_the_hand_where_it_is() -> None:
    answer = moved("arm")
    assert answer.motion_joints is not None
    assert answer.motion_base is not None
    (base,) = poses(answer.motion_base[None])
    with physics() as bullet:
        arm = Arm(bullet)
        for joints, hand in zip(answer.motion_joints, poses(answer.motion_hand), strict=True):
            assert base @ arm.base_from_grasp(joints) == pytest.approx(hand, abs=1e-6)
    assert moved("hand").motion_joints is None
    assert moved("hand").motion_base is None


def test_seen_from_elsewhere_it_is_the_same_motion() -> None:
    here = request((0, 0, 0.045), from_above(), box((0.02, 0.02, 0.03), (0, 0, 0.03)), width=0.04)
    fields = {"motion": True, "gripper": "robotiq_2f85", "actor": "hand"}
    there = request(
        (0, 0, 0.045),
        from_above(),
        box((0.02, 0.02, 0.03), (0, 0, 0.03)),
        width=0.04,
        seen_from=CAMERA_FROM_WORLD,
    )
    one, other = (execute(each.model_copy(update=fields)) for each in (here, there))
    turned = inverse(CAMERA_FROM_WORLD)
    for mine, its in zip(poses(one.motion_hand), poses(other.motion_hand), strict=True):
        assert turned @ its == pytest.approx(mine, abs=2e-3)
    free = one.motion_phases.index("close")  # then contacts make much of a rounding
    for mine, its in zip(
        poses(one.motion_object)[:free], poses(other.motion_object)[:free], strict=True
    ):
        assert turned @ its @ CAMERA_FROM_WORLD == pytest.approx(mine, abs=1e-4)


def test_the_pose_is_that_of_the_meshs_own_frame_where_it_has_one() -> None:
    vertices, faces = box((0.02, 0.02, 0.03), (0.5, 0.0, 0.0))
    place = Pose(position=(-0.5, 0.0, 0.029), quaternion=(0.0, 0.0, 0.0, 1.0))
    asked = request((0, 0, 0.045), from_above(), (vertices, faces), width=0.04, with_plane=True)
    sunk = {"object_pose": place, "gripper": "robotiq_2f85", "actor": "hand", "motion": True}
    answer = execute(asked.model_copy(update=sunk))
    first = poses(answer.motion_object)[0]
    assert first[:3, 3] == pytest.approx([-0.5, 0.0, 0.030], abs=5e-4)  # out of the table by 1 mm


def test_primitives_move_too() -> None:
    asked = request((0, 0, 0.1), from_side(), primitives=(STANDING_SUPERQUADRIC,), motion=True)
    answer = execute(asked.model_copy(update={"gripper": "robotiq_2f85", "actor": "hand"}))
    assert poses(answer.motion_object)[-1][2, 3] == pytest.approx(answer.lift_height, abs=0.01)


@pytest.mark.parametrize("far", [(2.0, 0.0, 0.12), (0.0, 0.0, 0.12)])
def test_there_is_none_where_nothing_moves(far: tuple[float, float, float]) -> None:
    width = 0.06 if far[0] else 0.081
    answer = execute(request(far, from_above(), cylinder(), width=width, motion=True))
    assert answer.outcome == "unreachable"
    assert "motion_" not in answer.model_dump_json()


@pytest.mark.parametrize("media_type", [JSON, NPZ])
def test_it_travels_as_the_other_arrays_do(media_type: str) -> None:
    answer = moved("arm")
    assert decode(ExecuteResponse, encode(answer, media_type), media_type, 10**7) == answer


def test_quaternions_follow_each_other() -> None:
    turns = Rotation.from_euler("xyz", [[0.3, 0.1, angle] for angle in np.linspace(0, 9, 60)])
    rows = pose_rows([pose_matrix(np.zeros(3), turn) for turn in turns.as_matrix()])
    assert np.einsum("fi,fi->f", rows[1:, 3:], rows[:-1, 3:]).min() > 0.9
    assert Rotation.from_quat(rows[:, 3:]).as_matrix() == pytest.approx(turns.as_matrix())
