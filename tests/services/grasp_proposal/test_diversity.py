from __future__ import annotations

import numpy as np

from services.grasp_proposal.diversity import Likeness, distinct
from tests.services.grasp_proposal.scenes import about_z


def test_keeps_the_best_of_each_group() -> None:
    centres = np.array([[0, 0, 0], [0.002, 0, 0], [0.05, 0, 0], [0.0, 0.003, 0]])
    assert distinct(centres, np.tile(np.eye(3), (4, 1, 1)), 10).tolist() == [0, 2]


def test_a_half_turn_is_the_same_grasp_and_a_quarter_turn_is_not() -> None:
    turns = np.stack([about_z(angle) for angle in (0, np.pi, np.pi / 2)])
    assert distinct(np.zeros((3, 3)), turns, 10).tolist() == [0, 2]


def test_limit_and_nothing() -> None:
    centres = np.column_stack([np.arange(20) * 0.1, np.zeros((20, 2))])
    assert distinct(centres, np.tile(np.eye(3), (20, 1, 1)), 5).tolist() == list(range(5))
    assert distinct(np.empty((0, 3)), np.empty((0, 3, 3)), 5).tolist() == []


def test_what_is_alike_can_be_said() -> None:
    centres = np.array([[0.0, 0, 0], [0.008, 0, 0]])
    turns = np.tile(np.eye(3), (2, 1, 1))
    assert distinct(centres, turns, 10, Likeness(0.006, 12.0)).tolist() == [0, 1]
    turns[1] = about_z(np.radians(15.0))
    assert distinct(np.zeros((2, 3)), turns, 10, Likeness(0.006, 12.0)).tolist() == [0, 1]
