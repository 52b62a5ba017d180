"""Boxes that fits start from."""

from __future__ import annotations

import numpy as np

from services.primitive_recovery.fitting.contact import Contact
from services.primitive_recovery.fitting.starts import THINNEST, all_starts, boxes, proportions
from services.primitive_recovery.fitting.terms import AT_MOST, EQUAL

FRAMES = np.array([np.eye(3), np.eye(3)[[1, 2, 0]]])
SUPPORTS = np.ones((4, 6)), np.ones((2, 6, 6))


def test_boxes_hold_the_points_and_reach_down_where_they_stand(rng: np.random.Generator) -> None:
    points = rng.uniform(-0.5, 0.5, (40, 3))
    down = np.array([0.0, 0.0, -1.0]) @ FRAMES
    low, high = boxes(points, FRAMES, down, 0.8, np.array([True, False]))
    local = points @ FRAMES
    np.testing.assert_array_equal(low[:, 1], local.min(axis=1))
    np.testing.assert_array_equal(high[:, 1], local.max(axis=1))
    changed = np.argwhere(low[:, 0] != low[:, 1]).tolist()
    assert changed == [[0, 2], [1, 0]]
    assert low[0, 0, 2] == low[1, 0, 0] == -0.8


def test_the_main_axis_is_the_odd_one_out() -> None:
    sizes = np.array([[[1.0, 1.1, 3.0], [2.0, 0.1, 2.1]]])
    size, main = proportions(np.zeros((1, 2, 3)), sizes, THINNEST)
    assert main.tolist() == [[[2, 0], [1, 2]]]
    np.testing.assert_allclose(size[0, 1], [2.0, 0.2, 2.1])


def test_every_frame_stands_and_floats_about_two_axes(rng: np.random.Generator) -> None:
    points = rng.uniform(-0.5, 0.5, (40, 3))
    contact = Contact(np.array([0.0, 0.0, 1.0]), 0.6, 0.01, True)
    starts = all_starts(points, FRAMES, True, SUPPORTS, contact)
    assert starts.supports.shape == (8, 11, 6)
    assert starts.supports[:, -1, 5].tolist() == [EQUAL, EQUAL, AT_MOST, AT_MOST] * 2
    assert (starts.odds[[0, 2, 4]] > starts.odds[6]).all()
    assert len(all_starts(points, FRAMES, False, SUPPORTS, None).odds) == 4
