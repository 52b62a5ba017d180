"""The request that a grasp is rehearsed with."""

from __future__ import annotations

import numpy as np
import pytest

from shared.rehearsal import rehearsals
from shared.schemas.execution import BELIEVED

GRASP = np.array([0.1, 0.2, 0.8, 0.0, 1.0, 0.0, 0.0, 0.03, 0.7])
BODY = (0.1, 1.0, 0.03, 0.03, 0.05, 0.1, 0.2, 0.8, 0.0, 0.0, 0.0, 1.0)
POINTS = np.array([[0.1, 0.2, 0.8], [0.1, 0.2, 0.9]])


@pytest.mark.parametrize(
    ("viewpoint", "heading"),
    [((0.0, 0.0, 0.0), (0.1, 0.2, 0.85)), ((0.1, 0.2, 0.85), None)],
)
def test_a_hand_alone_tries_it_strictly_on_whatever_is_believed(
    viewpoint: tuple[float, float, float], heading: tuple[float, ...] | None
) -> None:
    asked = rehearsals(
        GRASP,
        [BODY],
        points=POINTS,
        viewpoint=viewpoint,
        plane=None,
        up=(0.0, 0.0, 1.0),
        gripper="tiago",
    )
    assert tuple(each.believed for each in asked) == BELIEVED
    for each in asked:
        assert each.pose.position == (0.1, 0.2, 0.8)
        assert each.pose.quaternion == (0.0, 1.0, 0.0, 0.0)
        assert (each.width, each.gripper, each.actor) == (0.03, "tiago", "hand")
        assert each.strict
        assert each.primitives == (BODY,)
        assert each.viewpoint == viewpoint
        assert (each.points is None) == (each.believed == "primitives")
        assert each.heading == (None if heading is None else pytest.approx(heading))
