"""A gripper that flies by itself: each outcome, made to happen by physics."""

from __future__ import annotations

import numpy as np
import pytest

from shared.geometry.rotation import matrix_from_quaternion
from shared.geometry.se3 import pose_from_matrix
from shared.grippers import load_grippers
from shared.schemas.execution import ExecuteRequest, ExecuteResponse
from shared.schemas.grasp import Pose
from shared.schemas.gripper import ParallelGripper
from tests.services.execution.scenes import (
    CAMERA_FROM_WORLD,
    STANDING_SUPERQUADRIC,
    box,
    cylinder,
    execute,
    from_above,
    from_side,
    hull_mesh,
    request,
)

GRIPPERS = load_grippers()
PARALLEL = [name for name, each in GRIPPERS.items() if isinstance(each, ParallelGripper)]
LIFT = ("settle", "approach", "close", "lift", "hold")


def phases(answer: ExecuteResponse) -> tuple[str, ...]:
    return tuple(phase.name for phase in answer.phases)


def by_hand(asked: ExecuteRequest, **changes: object) -> ExecuteResponse:
    return execute(asked.model_copy(update={"actor": "hand", **changes}))


@pytest.mark.parametrize("name", PARALLEL)
def test_every_gripper_holds_a_block_that_fits(name: str) -> None:
    gripper = GRIPPERS[name]
    assert isinstance(gripper, ParallelGripper)
    wide = 0.8 * gripper.max_opening
    block = box((0.02, wide / 2, 0.05), (0, 0, 0.05))
    asked = request((0, 0, 0.08), from_above(), block, width=wide, gripper=name, strict=True)
    answer = by_hand(asked)
    assert answer.outcome == "held", answer.message
    assert answer.success
    assert answer.lifted
    assert phases(answer) == (*LIFT, "shake", "tilt")
    plain = by_hand(asked, strict=False)
    assert plain.outcome == "lifted"
    assert plain.success
    assert phases(plain) == LIFT
    wider = by_hand(asked, width=1.01 * gripper.max_opening)
    assert wider.outcome == "unreachable"
    assert name in wider.message


def test_a_hand_reaches_where_no_arm_could() -> None:
    asked = request((0, 0, 0.09), from_side(), cylinder())
    for yaw in np.arange(4) * np.pi / 2:
        answer = by_hand(request((0, 0, 0.09), from_side(yaw), cylinder()))
        assert answer.outcome == "lifted", answer.message
    assert by_hand(asked, strict=True).outcome == "held"


def test_beside_the_object_is_missed() -> None:
    answer = by_hand(request((0.12, 0, 0.12), from_above(), cylinder()))
    assert answer.outcome == "missed"
    assert phases(answer) == LIFT[:3]
    assert not answer.lifted


def test_a_palm_that_comes_down_on_the_table() -> None:
    low = box((0.02, 0.02, 0.01), (0, 0, 0.01))
    answer = by_hand(request((0, 0, 0.015), from_side(), low, width=0.04))
    assert answer.outcome == "collision_with_table", answer.message


def test_a_palm_that_presses_on_the_object() -> None:
    tall = box((0.02, 0.02, 0.05), (0, 0, 0.05))
    answer = by_hand(request((0, 0, 0.04), from_above(), tall, width=0.04))
    assert answer.outcome == "pushed_away"
    assert "palm pressed on the object" in answer.message


def test_a_hand_that_sweeps_the_object_along_pushes_it() -> None:
    answer = by_hand(request((0.05, 0.045, 0.09), from_side(), cylinder()))
    assert answer.outcome == "pushed_away", answer.message


def test_a_slope_steeper_than_the_friction_cone_slips() -> None:
    pyramid = hull_mesh(
        np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0], [0, 0, 1.25]]) * 0.04
    )
    answer = by_hand(request((0, 0, 0.03), from_above(), pyramid, width=0.07))
    assert answer.outcome in ("slipped_in_lift", "missed")
    assert not answer.lifted


def test_a_mesh_in_its_own_frame_is_the_same_mesh() -> None:
    mesh, moved = cylinder(), request((0, 0, 0.09), from_side(), cylinder(), strict=True)
    seen = request((0, 0, 0.09), from_side(), mesh, seen_from=CAMERA_FROM_WORLD, strict=True)

    position, quaternion = pose_from_matrix(CAMERA_FROM_WORLD)
    placed = seen.model_copy(
        update={
            "vertices": mesh[0],
            "object_pose": Pose(position=tuple(position), quaternion=tuple(quaternion)),
        }
    )
    answers = [by_hand(each) for each in (moved, seen, placed)]
    assert {answer.outcome for answer in answers} == {"held"}
    for answer in answers[1:]:
        assert answer.lift_height == pytest.approx(answers[0].lift_height, abs=3e-3)


def test_recovered_primitives_stand_for_the_object() -> None:
    answer = by_hand(
        request((0, 0, 0.1), from_side(), primitives=(STANDING_SUPERQUADRIC,)), strict=True
    )
    assert answer.outcome == "held", answer.message


def test_the_same_request_gives_the_same_answer() -> None:
    asked = request((0, 0, 0.09), from_side(), cylinder(), seen_from=CAMERA_FROM_WORLD, strict=True)
    first = by_hand(asked)
    by_hand(request((0.12, 0, 0.12), from_above(), cylinder()))
    assert by_hand(asked).model_dump_json() == first.model_dump_json()


def test_a_cup_holds_a_box_in_the_middle_and_loses_it_from_the_edge() -> None:
    block = box((0.06, 0.04, 0.02), (0, 0, 0.02))
    held = request((0, 0, 0.04), from_above(), block, width=0.0, gripper="onrobot_vgc10")
    answer = by_hand(held, strict=True)
    assert answer.outcome == "held", answer.message
    assert "cup" in answer.message
    heavy = box((0.25, 0.05, 0.02), (0, 0, 0.02))
    at_end = request((0.2, 0, 0.04), from_above(), heavy, width=0.0, gripper="onrobot_vgc10")
    lost = by_hand(at_end)
    assert lost.outcome == "slipped_in_lift", lost.message
    assert "peeling moment" in lost.message
    beside = request((0.05, 0, 0.04), from_above(), block, width=0.0, gripper="onrobot_vgc10")
    missed = by_hand(beside)
    assert missed.outcome == "missed"
    assert "lip" in missed.message


def test_a_heavy_bar_by_its_end_is_lost_when_shaken() -> None:
    """The bar hangs from the pads in the lift; shaken, its end swings out of them."""
    bar = box((0.25, 0.02, 0.015), (0, 0, 0.015))
    asked = request((0.22, 0, 0.022), from_above(), bar, width=0.04, strict=True)
    answer = by_hand(asked)
    assert answer.outcome in ("slipped_in_shake", "slipped_in_lift"), answer.message
    middle = by_hand(request((0, 0, 0.022), from_above(), bar, width=0.04, strict=True))
    assert middle.outcome == "held", middle.message


def test_what_is_told_to_be_heavy_is_lost() -> None:
    bar = box((0.1, 0.02, 0.015), (0, 0, 0.015))
    asked = request((0.07, 0, 0.022), from_above(), bar, width=0.04, strict=True)
    assert by_hand(asked, mass=0.06).outcome == "held"
    assert by_hand(asked, mass=1.5).outcome in ("slipped_in_lift", "slipped_in_shake")
    with pytest.raises(ValueError, match="greater than 0"):
        ExecuteRequest.model_validate({**dict(asked), "mass": 0.0})


def test_the_hand_is_filmed_and_the_film_changes_nothing() -> None:
    asked = request((0.12, 0, 0.12), from_above(), cylinder())
    answer = by_hand(asked, animate=True)
    assert answer.animation is not None
    assert bytes(answer.animation[:6]) == b"GIF89a"
    assert answer.model_copy(update={"animation": None}) == by_hand(asked)


def test_where_the_robot_faces_decides_which_way_it_tilts() -> None:
    """A long bar held by its end hangs; only one of the tilts takes it across the pads."""
    bar = box((0.15, 0.01, 0.01), (0.12, 0, 0.01))
    asked = request((0, 0, 0.01), from_above(), bar, width=0.02, strict=True, motion=True)
    as_it_comes = by_hand(asked)
    ends = {}
    for name, heading in {"x": (1, 0, 0), "y": (0, 1, 0), "back": (-1, 0, 0)}.items():
        answer = by_hand(asked, heading=tuple(map(float, heading)))
        assert answer.motion_hand is not None
        ends[name] = matrix_from_quaternion(answer.motion_hand[-1, 3:7])[:, 2]
    assert as_it_comes.motion_hand is not None
    comes = matrix_from_quaternion(as_it_comes.motion_hand[-1, 3:7])[:, 2]
    lean = np.sin(np.radians(60))
    np.testing.assert_allclose(ends["x"], [-lean, 0, -0.5], atol=0.03)
    np.testing.assert_allclose(ends["y"], [0, -lean, -0.5], atol=0.03)
    np.testing.assert_allclose(ends["back"], [lean, 0, -0.5], atol=0.03)
    np.testing.assert_allclose(comes, ends["x"], atol=0.03)


def test_a_brisk_trial_takes_less_and_tells_the_same_where_that_is_clear() -> None:
    block = box((0.02, 0.02, 0.05), (0, 0, 0.05))
    bar = box((0.25, 0.02, 0.015), (0, 0, 0.015))
    for asked, came in (
        (request((0, 0, 0.08), from_above(), block, width=0.04, strict=True), ("held",)),
        (
            request((0.22, 0, 0.022), from_above(), bar, width=0.04, strict=True),
            ("slipped_in_lift", "slipped_in_shake"),
        ),
        (request((0.12, 0, 0.12), from_above(), block, strict=True), ("missed",)),
    ):
        usual, brisk = by_hand(asked), by_hand(asked, brisk=True)
        assert usual.outcome in came
        assert brisk.outcome in came
        assert phases(brisk)[:3] == phases(usual)[:3]
        assert brisk.phases[-1].simulated_s < 0.9 * usual.phases[-1].simulated_s
    whole = by_hand(request((0, 0, 0.08), from_above(), block, width=0.04, strict=True), brisk=True)
    lasting = np.diff([phase.simulated_s for phase in whole.phases])
    np.testing.assert_allclose(lasting, [0.5, 0.25, 0.75, 0.5, 1.125, 0.75], atol=0.01)


def test_an_arm_can_be_brisk_too() -> None:
    asked = request((0, 0, 0.1), from_side(), cylinder())
    usual, brisk = execute(asked), execute(asked.model_copy(update={"brisk": True}))
    assert brisk.outcome == usual.outcome == "lifted"
    assert [each.name for each in brisk.phases] == [each.name for each in usual.phases]
