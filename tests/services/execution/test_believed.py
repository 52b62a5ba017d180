"""The other side of an object, which nobody has seen."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from services.execution.believed import DIRECTIONS, completed
from services.execution.checks import check_request
from services.execution.convex import ConvexPart
from shared.errors import PayloadTooLarge
from shared.grippers import load_grippers
from shared.schemas.execution import ExecuteRequest
from tests.services.execution.scenes import STANDING_SUPERQUADRIC, execute, from_side, request

Array = NDArray[np.float64]

SENSOR = np.array([-0.8, 0.0, 0.4])
HEIGHT = 0.16
CONE = (0.04, 0.01)
"""Radii at the bottom and at the top; its superquadric is a cylinder of 30 mm."""


def near_half() -> Array:
    """Return the side of the standing cone that is towards the sensor."""
    turn, height = np.meshgrid(np.linspace(-1.6, 1.6, 60), np.linspace(0, HEIGHT, 80))
    radius = CONE[0] + (CONE[1] - CONE[0]) * height / HEIGHT
    points = np.stack([-radius * np.cos(turn), radius * np.sin(turn), height], axis=-1)
    return points.reshape(-1, 3)


def widths(parts: list[ConvexPart], low: float, high: float) -> Array:
    """Return the extents in x and y of what lies between two heights."""
    corners = np.vstack([part.vertices for part in parts])
    some = corners[(corners[:, 2] >= low) & (corners[:, 2] <= high)]
    return np.asarray(np.ptp(some[:, :2], axis=0))


def test_the_far_side_of_a_cone_is_as_the_near_one() -> None:
    parts = completed(near_half(), [STANDING_SUPERQUADRIC], SENSOR)
    assert len(parts) == HEIGHT / 0.02
    np.testing.assert_allclose(widths(parts, 0.0, 0.02), 0.08, atol=0.003)
    np.testing.assert_allclose(widths(parts, 0.14, 0.16), 0.0275, atol=0.003)
    volume = sum(part.moments()[0] for part in parts)
    whole = np.pi * HEIGHT / 3 * (0.04**2 + 0.04 * 0.01 + 0.01**2)
    assert volume == pytest.approx(whole, rel=0.3), "neighbours overlap"


def test_a_hull_has_few_corners_and_hardly_less_than_all_points() -> None:
    parts = completed(near_half(), [STANDING_SUPERQUADRIC], SENSOR)
    assert max(len(part.vertices) for part in parts) <= DIRECTIONS
    for low in (0.0, 0.06, 0.12):
        wide = 2 * (CONE[0] + (CONE[1] - CONE[0]) * low / HEIGHT)
        assert widths(parts, low - 0.003, low + 0.003) == pytest.approx(wide, abs=0.003)


def test_the_answer_is_the_same_wherever_the_scene_is() -> None:
    shift = np.array([0.3, -0.2, 0.5])
    here = completed(near_half(), [STANDING_SUPERQUADRIC], SENSOR)
    vector = np.array(STANDING_SUPERQUADRIC)
    vector[5:8] += shift
    there = completed(near_half() + shift, [vector.tolist()], SENSOR + shift)
    for one, other in zip(here, there, strict=True):
        np.testing.assert_allclose(one.vertices + shift, other.vertices, atol=1e-9)


def test_too_few_points_are_no_parts() -> None:
    assert completed(near_half()[:5], [STANDING_SUPERQUADRIC], SENSOR) == []


def tried(believed: str) -> ExecuteRequest:
    return request(
        (0.0, 0.0, 0.145),
        from_side(),
        primitives=(STANDING_SUPERQUADRIC,),
        width=0.03,
        points=near_half(),
        viewpoint=tuple(SENSOR),
        believed=believed,
        actor="hand",
    )


def test_what_is_believed_decides_what_happens() -> None:
    """Open for the narrow end of a cone, the fingers run into the cylinder."""
    assert execute(tried("primitives")).outcome != "lifted"
    assert execute(tried("reflected")).outcome == "lifted"


def test_without_enough_points_the_primitives_are_what_is_believed() -> None:
    few = tried("reflected").model_copy(update={"points": near_half()[:5]})
    assert execute(few) == execute(tried("primitives"))


def test_points_that_cannot_be_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    for wrong, told in (
        ({"points": None}, "give both"),
        ({"primitives": ()}, "give a mesh"),
        ({"points": np.full((20, 3), np.nan)}, "finite"),
        ({"points": np.empty((0, 3))}, "must be some"),
    ):
        fields = {name: getattr(tried("reflected"), name) for name in ExecuteRequest.model_fields}
        with pytest.raises(ValueError, match=told):
            ExecuteRequest(**{**fields, **wrong})
    monkeypatch.setattr("services.execution.checks.MAX_POINTS", 100)
    with pytest.raises(PayloadTooLarge, match="points has 4800 rows"):
        check_request(tried("reflected"), load_grippers())
