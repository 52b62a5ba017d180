"""Each outcome, made to happen by physics."""

from __future__ import annotations

import numpy as np
import pytest

from services.execution.placement import LIFT_HEIGHT
from shared.schemas.execution import ExecuteResponse
from tests.services.execution.scenes import (
    CAMERA_FROM_WORLD,
    STANDING_SUPERQUADRIC,
    box,
    cylinder,
    execute,
    from_above,
    from_side,
    hull_mesh,
    joined,
    request,
)

PHASES = ("settle", "drive", "approach", "close", "lift", "hold")


def phases(answer: ExecuteResponse) -> tuple[str, ...]:
    return tuple(phase.name for phase in answer.phases)


@pytest.mark.parametrize("seen_from", [None, CAMERA_FROM_WORLD])
@pytest.mark.parametrize(
    ("position", "rotation"),
    [((0, 0, 0.12), from_above(0.4)), ((0, 0, 0.09), from_side()), ((0, 0, 0.06), from_side(2.5))],
)
def test_a_standing_cylinder_is_lifted_from_any_side(
    position: tuple[float, float, float], rotation: np.ndarray, seen_from: np.ndarray | None
) -> None:
    answer = execute(request(position, rotation, cylinder(), seen_from=seen_from, with_plane=True))
    assert answer.outcome == "lifted", answer.message
    assert answer.success
    assert answer.lift_height == pytest.approx(LIFT_HEIGHT, abs=0.01)
    assert phases(answer) == PHASES
    times = [phase.simulated_s for phase in answer.phases]
    assert times == sorted(times)


@pytest.mark.parametrize("with_plane", [True, False])
def test_primitives_stand_for_the_object(with_plane: bool) -> None:
    answer = execute(
        request(
            (0, 0, 0.1),
            from_side(),
            primitives=(STANDING_SUPERQUADRIC,),
            seen_from=CAMERA_FROM_WORLD,
            with_plane=with_plane,
        )
    )
    assert answer.outcome == "lifted", answer.message


def test_several_primitives_are_one_body() -> None:
    along_x = (0.0, np.sqrt(0.5), 0.0, np.sqrt(0.5))
    handle = (0.2, 1.0, 0.012, 0.012, 0.09, 0.0, 0.0, 0.02, *along_x)
    head = (0.2, 0.2, 0.015, 0.035, 0.02, 0.09, 0.0, 0.02, 0.0, 0.0, 0.0, 1.0)
    answer = execute(request((0.02, 0, 0.02), from_above(), primitives=(handle, head), width=0.024))
    assert answer.outcome == "lifted", answer.message


def test_a_handle_is_grasped_through_its_opening() -> None:
    """A mug-like frame: its convex hull would leave no room for the inner finger."""
    frame = joined(
        box((0.06, 0.01, 0.01), (0.0, 0.0, 0.01)),
        box((0.06, 0.01, 0.01), (0.0, 0.1, 0.01)),
        box((0.01, 0.06, 0.01), (0.05, 0.05, 0.01)),
        box((0.01, 0.06, 0.01), (-0.05, 0.05, 0.01)),
    )
    answer = execute(request((0, 0, 0.015), from_above(), frame, width=0.02))
    assert answer.outcome == "lifted", answer.message


def test_an_object_that_cannot_stand_is_held_up_and_lifted() -> None:
    leaning = (0.1, 1.0, 0.015, 0.015, 0.1, 0.0, 0.0, 0.12, 0.0, 0.25, 0.0, 0.97)
    answer = execute(request((0, 0, 0.12), from_above(), primitives=(leaning,), width=0.03))
    assert answer.outcome == "lifted", answer.message
    assert "propped up" in answer.message


def test_beside_the_object_is_missed() -> None:
    answer = execute(request((0.12, 0, 0.12), from_above(), cylinder()))
    assert answer.outcome == "missed"
    assert "on nothing" in answer.message
    assert phases(answer) == PHASES[:4]


def test_two_metres_away_is_unreachable() -> None:
    answer = execute(request((2, 0, 0.12), from_above(), cylinder()))
    assert answer.outcome == "unreachable"
    assert "none of 48" in answer.message


def test_wider_than_the_hand_is_unreachable() -> None:
    answer = execute(request((0, 0, 0.12), from_above(), cylinder(), width=0.081))
    assert answer.outcome == "unreachable"
    assert "81.0 mm" in answer.message
    assert "80.0 mm" in answer.message


@pytest.mark.parametrize(("rotation", "where"), [(from_above(), "grasp"), (np.eye(3), "pregrasp")])
def test_a_hand_inside_the_table_is_a_collision(rotation: np.ndarray, where: str) -> None:
    answer = execute(request((0, 0, -0.02), rotation, cylinder(), with_plane=True))
    assert answer.outcome == "collision_with_table"
    assert f"at the {where} pose" in answer.message
    assert answer.phases == ()


def test_a_low_sideways_grasp_brings_the_arm_into_the_table() -> None:
    """The hand would just fit above the table, the wrist behind it would not."""
    flat = box((0.02, 0.02, 0.02), (0, 0, 0.02))
    answer = execute(request((0, 0, 0.034), from_side(), flat, width=0.04))
    assert answer.outcome == "collision_with_table"
    assert "none keeps off the table: at best, panda_link" in answer.message


def test_a_grasp_a_little_too_deep_is_raised_to_the_table() -> None:
    plate = box((0.06, 0.01, 0.006), (0, 0, 0.006))
    answer = execute(request((0, 0, 0.006), from_above(), plate, width=0.02))
    assert answer.outcome == "lifted", answer.message


def test_fingers_that_land_on_the_object_push_it() -> None:
    block = box((0.05, 0.05, 0.03), (0, 0, 0.03))
    answer = execute(request((0, 0, 0.045), from_above(), block, width=0.03))
    assert answer.outcome == "pushed_away"
    assert "finger pressed on the object" in answer.message


def test_a_hand_that_sweeps_the_object_along_pushes_it() -> None:
    ball = (1.0, 1.0, 0.03, 0.03, 0.03, 0.0, 0.0, 0.03, 0.0, 0.0, 0.0, 1.0)
    answer = execute(request((0.05, 0.045, 0.05), from_side(), primitives=(ball,), width=0.06))
    assert answer.outcome == "pushed_away", answer.message


def test_a_slope_steeper_than_the_friction_cone_slips() -> None:
    """Sides at 51 degrees from the vertical; friction 0.6 holds up to 31."""
    pyramid = hull_mesh(
        np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0], [0, 0, 1.25]]) * 0.04
    )
    answer = execute(request((0, 0, 0.03), from_above(), pyramid, width=0.07))
    assert answer.outcome == "slipped_in_lift"
    assert phases(answer) == PHASES


def test_a_bar_held_by_its_end_hangs() -> None:
    """Two pads cannot hold a long bar level: its centre rises less than the hand."""
    bar = box((0.3, 0.02, 0.02), (0, 0, 0.02))
    answer = execute(request((0.1, 0, 0.03), from_above(), bar, width=0.04))
    assert answer.outcome == "lifted", answer.message
    assert answer.lift_height < LIFT_HEIGHT - 0.03


def test_the_same_request_gives_the_same_answer() -> None:
    asked = request((0, 0, 0.09), from_side(), cylinder(), seen_from=CAMERA_FROM_WORLD)
    other = request((0.12, 0, 0.12), from_above(), cylinder())
    first = execute(asked)
    execute(other)
    assert execute(asked).model_dump_json() == first.model_dump_json()


def test_the_arm_shakes_and_tilts_what_it_lifted() -> None:
    answer = execute(request((0, 0, 0.09), from_side(), cylinder(), strict=True))
    assert answer.lifted, answer.message
    assert answer.outcome in ("held", "unreachable"), answer.message
    assert answer.success == (answer.outcome == "held")
