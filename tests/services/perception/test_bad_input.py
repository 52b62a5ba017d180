"""Every bad view gets the error that names its fault."""

from __future__ import annotations

import contextlib
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from services.perception.perceive import Perception
from services.perception.settings import PerceptionSettings
from shared.errors import (
    DegenerateCloud,
    EmptyCloud,
    InvalidInput,
    NoObject,
    PayloadTooLarge,
    WrongUnits,
)
from shared.schemas.scene import InputKind, PerceiveRequest
from tests.services.perception.scenes import small_view

Array = NDArray[np.float64]

STAGE = Perception()
KINDS: tuple[InputKind, ...] = ("scene", "object")
INTRINSICS = np.array([[60.0, 0, 32], [0, 60, 24], [0, 0, 1]])


def flat(count: int = 3000) -> Array:
    rng = np.random.default_rng(1)
    return np.column_stack([rng.uniform(-0.3, 0.3, (count, 2)), np.full(count, 0.8)])


def perceive(points: Array, kind: InputKind) -> None:
    STAGE.perceive(PerceiveRequest(points=points, input=kind))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    "points",
    [
        np.empty((0, 3)),
        np.ones((1, 3)),
        np.full((500, 3), np.nan),
        np.full((500, 3), -np.inf),
        np.vstack([flat(10), np.full((500, 3), np.nan)]),
    ],
    ids=["none", "one", "nan", "inf", "few"],
)
def test_too_few_valid_points(points: Array, kind: InputKind) -> None:
    with pytest.raises(EmptyCloud, match="at least 30 are needed") as caught:
        perceive(points, kind)
    assert caught.value.details["input_points"] == len(points)


@pytest.mark.parametrize(
    "depth",
    [
        np.zeros((48, 64), np.uint16),
        np.full((48, 64), 65535, np.uint16),
        np.full((48, 64), -1, np.int32),
        np.full((48, 64), np.nan, np.float32),
        np.full((48, 64), np.inf),
        np.full((48, 64), 1e308),
        np.zeros((0, 64), np.uint16),
        np.ones((1, 1), np.uint16),
    ],
    ids=["zero", "saturated", "negative", "nan", "inf", "overflow", "no rows", "one pixel"],
)
def test_a_depth_image_without_returns(depth: NDArray[Any]) -> None:
    with pytest.raises(EmptyCloud):
        STAGE.perceive(PerceiveRequest(depth=depth, intrinsics=INTRINSICS, depth_scale=1e9))


@pytest.mark.parametrize("kind", KINDS)
def test_duplicates_and_lines(kind: InputKind) -> None:
    with pytest.raises(DegenerateCloud, match="one spot"):
        perceive(np.ones((1000, 3)), kind)
    with pytest.raises(DegenerateCloud, match="a line"):
        perceive(np.linspace(0, 1, 500)[:, None] * [1.0, 2.0, 3.0], kind)
    with pytest.raises(DegenerateCloud, match="divided by 1000"):
        perceive(flat() * 1e-4, kind)


def test_all_points_on_a_plane() -> None:
    with pytest.raises(NoObject, match="nothing stands out"):
        perceive(flat(), "scene")
    with pytest.raises(DegenerateCloud, match="exactly on a plane"):
        perceive(flat(), "object")
    with pytest.raises(DegenerateCloud, match="exactly on a plane"):
        perceive(flat().astype(np.float32).astype(np.float64), "object")


def test_a_noisy_face_is_an_object(rng: np.random.Generator) -> None:
    points = flat() + rng.normal(0, 1e-4, (3000, 3))
    answer = STAGE.perceive(PerceiveRequest(points=points, input="object"))
    assert len(answer.object_points) == 3000


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("factor", [1e3, 1e6, 1e12, 1e300])
def test_points_in_millimetres_or_worse(kind: InputKind, factor: float) -> None:
    with pytest.raises(WrongUnits, match="millimetres") as caught:
        perceive(np.random.default_rng(0).random((500, 3)) * factor, kind)
    assert caught.value.details["field"] == "points"


@pytest.mark.parametrize("size_mm", [20.0, 100.0, 400.0])
def test_an_object_in_millimetres(size_mm: float) -> None:
    points = np.random.default_rng(0).random((500, 3)) * size_mm
    with pytest.raises(WrongUnits, match="divide them by 1000"):
        perceive(points, "object")


def test_depth_with_the_wrong_scale() -> None:
    shot = small_view()
    for depth, scale in (
        (np.rint(shot.depth * 1000).astype(np.uint16), 1.0),
        (shot.depth * 1000, None),
        (shot.depth, 1e308),  # the points are infinite, the depth is not
    ):
        with pytest.raises(WrongUnits, match="depth_scale") as caught:
            STAGE.perceive(
                PerceiveRequest(depth=depth, intrinsics=shot.intrinsics, depth_scale=scale)
            )
        assert caught.value.details["field"] == "depth"


def test_a_target_in_millimetres() -> None:
    with pytest.raises(WrongUnits, match="target"):
        STAGE.perceive(small_view().request(target=(30.0, 20.0, 850.0)))


def test_metres_of_any_size_are_not_misjudged(rng: np.random.Generator) -> None:
    """A hall of 30 m behind the table, and a frame whose origin is 200 m away."""
    shot = small_view()
    hall = rng.uniform([-15, -5, 10], [15, 5, 40], (5000, 3))
    points = np.vstack([shot.cloud(), hall])
    answer = STAGE.perceive(PerceiveRequest(points=points))
    assert shot.pixels("box")[answer.object_indices].mean() > 0.95
    away = np.array([200.0, -150.0, 3.0])
    answer = STAGE.perceive(
        PerceiveRequest(points=shot.cloud() + away, viewpoint=tuple(away.tolist()))
    )
    assert shot.pixels("box")[answer.object_indices].mean() > 0.95


def test_a_viewpoint_out_of_this_world() -> None:
    with pytest.raises(InvalidInput, match="viewpoint"):
        STAGE.perceive(PerceiveRequest(points=flat(), viewpoint=(9e5, 0, 0)))


def test_too_many_points() -> None:
    stage = Perception(PerceptionSettings(max_points=1000))
    with pytest.raises(PayloadTooLarge, match="at most 1000"):
        stage.perceive(PerceiveRequest(points=flat()))


def test_an_object_is_passed_on_whole(rng: np.random.Generator) -> None:
    points = rng.normal(0, 0.03, (500, 3)) + np.array([0, 0, 0.6])
    points[::7] = np.nan
    answer = STAGE.perceive(PerceiveRequest(points=points, input="object"))
    valid = np.flatnonzero(np.isfinite(points).all(axis=1))
    np.testing.assert_array_equal(answer.object_indices, valid)
    np.testing.assert_array_equal(answer.object_points, points[valid])
    assert answer.plane is None
    assert answer.clusters == 1
    assert answer.dropped == {"invalid": 72, "support": 0, "other": 0}
    assert len(answer.obstacle_points) == 0


def test_up_without_a_plane() -> None:
    """Half down the image and half towards the sensor; z in a fixed frame."""
    points = np.random.default_rng(0).normal(0, 0.03, (500, 3)) + np.array([0, 0, 0.6])
    camera = STAGE.perceive(PerceiveRequest(points=points, input="object"))
    np.testing.assert_allclose(camera.up, np.array([0, -1, -1]) / np.sqrt(2))
    fixed = STAGE.perceive(PerceiveRequest(points=points, input="object", viewpoint=(0, 0, 1.5)))
    assert fixed.up == (0, 0, 1)


@settings(max_examples=60, deadline=None)
@given(
    points=arrays(
        np.float64,
        st.tuples(st.integers(0, 80), st.just(3)),
        elements=st.one_of(
            st.sampled_from([0.0, 1.0, 0.5, np.nan, np.inf, -np.inf, 1e308, 1e-308, -1.0]),
            st.floats(-2, 2),
        ),
    ),
    kind=st.sampled_from(KINDS),
)
def test_nothing_but_our_errors(points: Array, kind: InputKind) -> None:
    with contextlib.suppress(InvalidInput):
        answer = STAGE.perceive(PerceiveRequest(points=points, input=kind))
        assert np.isfinite(answer.object_points).all()
        assert len(answer.object_indices) + sum(answer.dropped.values()) == len(points)
