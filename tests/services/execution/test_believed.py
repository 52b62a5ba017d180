"""The other side of an object, which nobody has seen."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from services.execution.believed import Completion, completed
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
BOTH = pytest.mark.parametrize("how", ["turned", "reflected"])


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


@BOTH
def test_the_far_side_of_a_cone_is_as_the_near_one(how: Completion) -> None:
    parts = completed(near_half(), [STANDING_SUPERQUADRIC], SENSOR, how)
    assert len(parts) == HEIGHT / 0.02
    np.testing.assert_allclose(widths(parts, 0.0, 0.02), 0.08, atol=0.003)
    np.testing.assert_allclose(widths(parts, 0.14, 0.16), 0.0275, atol=0.003)
    volume = sum(part.moments()[0] for part in parts)
    whole = np.pi * HEIGHT / 3 * (0.04**2 + 0.04 * 0.01 + 0.01**2)
    assert volume == pytest.approx(whole, rel=0.3), "neighbours overlap"


def test_an_oval_that_stands_aslant_is_itself_when_it_is_turned() -> None:
    """Seen from the side of one of its corners, so to say; its reflection is another oval."""
    turn = np.linspace(0, 2 * np.pi, 240, endpoint=False)
    oval = np.stack([0.04 * np.cos(turn), 0.02 * np.sin(turn)], axis=-1)
    aslant = oval @ np.array([[1, 1], [-1, 1]]) / np.sqrt(2)
    ring = aslant[aslant[:, 0] < 0]
    levels = np.linspace(0, HEIGHT, 80)
    seen = np.vstack([np.column_stack([ring, np.full(len(ring), z)]) for z in levels])
    spans = {}
    for how in ("turned", "reflected"):
        parts = completed(seen, [STANDING_SUPERQUADRIC], SENSOR * [1, 0, 1], how)
        corners = np.vstack([part.vertices for part in parts])[:, :2]
        spans[how] = [float(np.ptp(corners @ each)) for each in aslant[[0, 60]] / 0.04]
    assert spans["turned"] == pytest.approx([0.08, 0.04 * 0.5], rel=0.1)
    assert spans["reflected"][1] > 1.4 * spans["turned"][1]


@BOTH
def test_the_answer_is_the_same_wherever_the_scene_is(how: Completion) -> None:
    shift = np.array([0.3, -0.2, 0.5])
    here = completed(near_half(), [STANDING_SUPERQUADRIC], SENSOR, how)
    vector = np.array(STANDING_SUPERQUADRIC)
    vector[5:8] += shift
    there = completed(near_half() + shift, [vector.tolist()], SENSOR + shift, how)
    for one, other in zip(here, there, strict=True):
        np.testing.assert_allclose(one.vertices + shift, other.vertices, atol=1e-9)


@BOTH
def test_too_few_points_are_no_parts(how: Completion) -> None:
    assert completed(near_half()[:5], [STANDING_SUPERQUADRIC], SENSOR, how) == []


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
    assert execute(tried("turned")).outcome == "lifted"
    assert execute(tried("reflected")).outcome == "lifted"


def test_without_enough_points_the_primitives_are_what_is_believed() -> None:
    few = tried("turned").model_copy(update={"points": near_half()[:5]})
    assert execute(few) == execute(tried("primitives"))


def test_points_that_cannot_be_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    for wrong, told in (
        ({"points": None}, "give both"),
        ({"primitives": ()}, "give a mesh"),
        ({"points": np.full((20, 3), np.nan)}, "finite"),
        ({"points": np.empty((0, 3))}, "must be some"),
    ):
        fields = {name: getattr(tried("turned"), name) for name in ExecuteRequest.model_fields}
        with pytest.raises(ValueError, match=told):
            ExecuteRequest(**{**fields, **wrong})
    monkeypatch.setattr("services.execution.checks.MAX_POINTS", 100)
    with pytest.raises(PayloadTooLarge, match="points has 4800 rows"):
        check_request(tried("turned"), load_grippers())
