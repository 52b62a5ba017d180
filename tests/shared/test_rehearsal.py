"""The request that a grasp is rehearsed with."""

from __future__ import annotations

import numpy as np
import pytest

from shared.rehearsal import rehearsal

GRASP = np.array([0.1, 0.2, 0.8, 0.0, 1.0, 0.0, 0.0, 0.03, 0.7])
BODY = (0.1, 1.0, 0.03, 0.03, 0.05, 0.1, 0.2, 0.8, 0.0, 0.0, 0.0, 1.0)
POINTS = np.array([[0.1, 0.2, 0.8], [0.1, 0.2, 0.9]])


@pytest.mark.parametrize(
    ("viewpoint", "heading"),
    [((0.0, 0.0, 0.0), (0.1, 0.2, 0.85)), ((0.1, 0.2, 0.85), None)],
)
def test_a_hand_alone_tries_it_strictly_on_the_superquadrics(
    viewpoint: tuple[float, ...], heading: tuple[float, ...] | None
) -> None:
    asked = rehearsal(
        GRASP,
        [BODY],
        points=POINTS,
        viewpoint=viewpoint,
        plane=None,
        up=(0.0, 0.0, 1.0),
        gripper="tiago",
    )
    assert asked.pose.position == (0.1, 0.2, 0.8)
    assert asked.pose.quaternion == (0.0, 1.0, 0.0, 0.0)
    assert (asked.width, asked.gripper, asked.actor) == (0.03, "tiago", "hand")
    assert asked.strict
    assert asked.primitives == (BODY,)
    assert asked.heading == (None if heading is None else pytest.approx(heading))
