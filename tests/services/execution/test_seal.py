from __future__ import annotations

import numpy as np
import pytest

from services.execution.seal import first_heights, pulled_off, seal
from shared.grippers import load_grippers
from shared.schemas.gripper import SuctionGripper

CUP = SuctionGripper(
    kind="suction",
    name="cup",
    description="of these tests",
    cup_diameter=0.03,
    cup_length=0.03,
    compliance=0.003,
    palm_size=(0.05, 0.05, 0.06),
    force=20.0,
)
NOTHING = np.zeros(3)


def plate(tilt: float = 0.0, half: float = 0.1, height: float = 0.0) -> np.ndarray:
    x = half * np.array([-1.0, 1.0, 1.0, -1.0])
    y = half * np.array([-1.0, -1.0, 1.0, 1.0])
    corners = np.column_stack([x, y, height + np.tan(tilt) * x])
    return corners[[[0, 1, 2], [0, 2, 3]]]


def test_heights_are_those_of_the_nearest_surface() -> None:
    both = np.concatenate([plate(height=0.02), plate(height=0.01), plate(height=-0.5)])
    points = np.array([[0.0, 0.0], [0.05, -0.03], [1.0, 0.0]])
    np.testing.assert_allclose(first_heights(points, both, above=-0.03), [0.01, 0.01, np.inf])


@pytest.mark.parametrize(
    ("surface", "says"),
    [
        (plate(), ""),
        (plate(np.arctan(0.099)), ""),
        (plate(np.arctan(0.101)), "varies by"),
        (plate(half=0.012), "meet no surface"),
        (plate(height=0.0031), "before the lip"),
    ],
)
def test_what_a_lip_follows(surface: np.ndarray, says: str) -> None:
    """A lip 30 mm wide that gives way by 3 mm follows a slope of a tenth."""
    found = seal(CUP, surface)
    assert found.sealed == (not says)
    assert says in found.message


def test_how_a_cup_is_pulled_off() -> None:
    assert pulled_off(CUP, np.array([0, 0, -19.9]), NOTHING) is None
    assert "pull" in str(pulled_off(CUP, np.array([0, 0, -20.1]), NOTHING))
    assert pulled_off(CUP, np.array([9.9, 0, 0]), NOTHING) is None
    assert "sideways" in str(pulled_off(CUP, np.array([0, 10.1, 0]), NOTHING))
    assert pulled_off(CUP, NOTHING, np.array([0.149, 0, 0])) is None
    assert "peeling" in str(pulled_off(CUP, NOTHING, np.array([0, 0.151, 0])))
    assert "twist" in str(pulled_off(CUP, NOTHING, np.array([0, 0, 0.151])))
    pulling = np.array([0, 0, -10.0])
    assert "peeling" in str(pulled_off(CUP, pulling, np.array([0.076, 0, 0])))


def test_shipped_cups_seal_on_a_plate() -> None:
    cups = [each for each in load_grippers().values() if isinstance(each, SuctionGripper)]
    assert all(seal(cup, plate(half=0.3)).sealed for cup in cups)
