"""The stage as its client sees it: messages in, messages out, clear errors."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from services.primitive_recovery.recovery import PrimitiveRecovery
from services.primitive_recovery.settings import PrimitiveRecoverySettings
from shared.errors import (
    DegenerateCloud,
    EmptyCloud,
    InvalidInput,
    PayloadTooLarge,
    SpargeError,
    WrongUnits,
)
from shared.schemas.primitive import (
    PRESETS,
    EmsParameters,
    Method,
    Preset,
    RecoverRequest,
    RecoverResponse,
)
from tests.services.primitive_recovery.clouds import Array, hammer, superquadric, surface_points


@pytest.fixture(scope="module")
def stage() -> PrimitiveRecovery:
    stage = PrimitiveRecovery(PrimitiveRecoverySettings())
    stage.warm_up()
    return stage


@pytest.fixture
def can(rng: np.random.Generator) -> Array:
    body = superquadric((0.1, 1.0), (0.033, 0.033, 0.06), (0.1, -0.05, 0.8))
    return surface_points(body, 2000, rng)


def assert_sound(response: RecoverResponse, points: Array) -> None:
    assert response.primitives
    assert [one.id for one in response.primitives] == list(range(len(response.primitives)))
    supports = [one.support for one in response.primitives]
    assert supports == sorted(supports, reverse=True)
    assert sum(supports) <= len(points)
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    for one in response.primitives:
        parameters = np.array(one.parameters)
        assert np.isfinite(parameters).all()
        assert ((parameters[:2] >= 0.1) & (parameters[:2] <= 2.0)).all()
        assert np.linalg.norm(parameters[8:]) == pytest.approx(1.0)
        np.testing.assert_allclose(one.full_extents, 2 * parameters[2:5])
        assert (parameters[2:5] > 0).all()
        assert max(one.full_extents) <= 3 * size
        assert np.linalg.norm(parameters[5:8] - points.mean(axis=0)) <= 3 * size


def test_a_can_is_a_cylinder(stage: PrimitiveRecovery, can: Array) -> None:
    response = stage.recover(RecoverRequest(points=can, method="ems"))
    assert_sound(response, can)
    (primitive,) = response.primitives
    assert primitive.shape_class == "cylinder"
    np.testing.assert_allclose(sorted(primitive.full_extents), [0.066, 0.066, 0.12], atol=0.004)
    assert primitive.residual_mm < 1.0
    assert response.removed_as_overlap == 0


@pytest.mark.parametrize("preset", ["simulation", "real_world"])
def test_a_hammer(stage: PrimitiveRecovery, preset: Preset, rng: np.random.Generator) -> None:
    points = hammer(rng)
    request = RecoverRequest(points=points, preset=preset)
    response = stage.recover(request)
    assert_sound(response, points)
    assert stage.recover(request) == response


def test_requests_in_several_threads_get_the_same_answer(
    stage: PrimitiveRecovery, rng: np.random.Generator
) -> None:
    request = RecoverRequest(points=hammer(rng))
    alone = stage.recover(request)
    with ThreadPoolExecutor(4) as pool:
        assert all(found == alone for found in pool.map(stage.recover, [request] * 8))


def test_the_setting_is_the_default_preset(can: Array) -> None:
    real = PrimitiveRecovery(PrimitiveRecoverySettings(method="ems", preset="real_world"))
    asked = PrimitiveRecovery(PrimitiveRecoverySettings())
    assert real.recover(RecoverRequest(points=can)) == asked.recover(
        RecoverRequest(points=can, preset="real_world")
    )


@pytest.mark.parametrize(
    ("setting", "asked", "expected"),
    [
        ("parts", {}, "parts"),
        ("ems", {}, "ems"),
        ("ems", {"method": "parts"}, "parts"),
        ("parts", {"method": "ems"}, "ems"),
        ("parts", {"preset": "real_world"}, "ems"),
        ("parts", {"parameters": PRESETS["simulation"]}, "ems"),
        ("parts", {"method": "parts", "preset": "real_world"}, "parts"),
    ],
)
def test_the_method_is_the_one_asked_for(
    setting: Method, asked: dict[str, Any], expected: Method, can: Array
) -> None:
    stage = PrimitiveRecovery(PrimitiveRecoverySettings(method=setting))
    assert stage.recover(RecoverRequest(points=can, **asked)).method == expected


def test_parameters_of_the_request_win_over_the_preset(
    stage: PrimitiveRecovery, rng: np.random.Generator
) -> None:
    points = hammer(rng)
    real = PRESETS["real_world"]
    named = stage.recover(RecoverRequest(points=points, preset="real_world"))
    given = RecoverRequest(points=points, preset="simulation", parameters=real)
    assert stage.recover(given) == named
    alone = real.model_copy(update={"min_points": 100_000})
    assert len(stage.recover(RecoverRequest(points=points, parameters=alone)).primitives) == 1


def turned_plane(rng: np.random.Generator) -> Array:
    flat = rng.uniform(-0.05, 0.05, (500, 2))
    across = np.array([[1.0, 0.5, 0.2], [0.1, -0.4, 0.9]])
    return np.asarray(flat @ across + [0.0, 0.0, 0.8])


@pytest.mark.parametrize(
    ("make", "error"),
    [
        (lambda rng: np.zeros((0, 3)), EmptyCloud),
        (lambda rng: np.zeros((1, 3)), EmptyCloud),
        (lambda rng: rng.normal(size=(10, 3)), EmptyCloud),
        (lambda rng: np.full((20, 3), 0.4), DegenerateCloud),
        (lambda rng: np.outer(np.linspace(0, 0.1, 50), [1, 2, 3]), DegenerateCloud),
        (turned_plane, DegenerateCloud),
        (lambda rng: turned_plane(rng).astype(np.float32), DegenerateCloud),
        (lambda rng: rng.normal(size=(50, 3)) * 40, WrongUnits),
        (lambda rng: rng.choice([-1.7e308, 1.7e308], (50, 3)), WrongUnits),
        (lambda rng: rng.normal(size=(50, 3)) * 0.01 + 1e9, DegenerateCloud),
        (lambda rng: np.vstack([rng.normal(size=(50, 3)), [[0, np.nan, 0]]]), InvalidInput),
        (lambda rng: np.vstack([rng.normal(size=(50, 3)), [[0, np.inf, 0]]]), InvalidInput),
    ],
)
def test_bad_clouds_are_named(
    stage: PrimitiveRecovery, make: object, error: type[SpargeError], rng: np.random.Generator
) -> None:
    assert callable(make)
    with pytest.raises(error) as caught:
        stage.recover(RecoverRequest(points=make(rng)))
    assert type(caught.value) is error
    assert caught.value.details["field"] == "points"
    assert caught.value.message.startswith("points: ")


def test_too_many_points_are_refused(can: Array) -> None:
    small = PrimitiveRecovery(PrimitiveRecoverySettings(max_points=1000))
    with pytest.raises(PayloadTooLarge):
        small.recover(RecoverRequest(points=can))


@pytest.mark.parametrize(
    ("obstacles", "error"),
    [
        (np.array([[0.1, np.nan, 0.5]]), InvalidInput),
        (np.array([[0.1, np.inf, 0.5]]), InvalidInput),
        (np.array([[0.1, 1e200, 0.5]]), InvalidInput),
        (np.zeros((3000, 3)), PayloadTooLarge),
    ],
)
def test_bad_obstacles_are_named(can: Array, obstacles: Array, error: type[SpargeError]) -> None:
    stage = PrimitiveRecovery(PrimitiveRecoverySettings(max_points=2500))
    with pytest.raises(error) as caught:
        stage.recover(RecoverRequest(points=can, obstacle_points=obstacles))
    assert caught.value.details["field"] == "obstacle_points"


@pytest.mark.parametrize("count", [11, 12, 20, 60])
def test_a_few_points_are_enough(
    stage: PrimitiveRecovery, count: int, rng: np.random.Generator
) -> None:
    points = rng.normal(size=(count, 3)) * 0.03
    assert_sound(stage.recover(RecoverRequest(points=points)), points)


@pytest.mark.parametrize(
    "make",
    [
        lambda rng: np.repeat(rng.normal(size=(5, 3)) * 0.05, 20, axis=0),
        lambda rng: np.vstack([np.zeros((500, 3)), rng.normal(size=(100, 3)) * 0.03]),
        lambda rng: rng.choice([-0.05, 0.05], (64, 3)),
        lambda rng: rng.normal(size=(300, 3)) * 1e-5,
        lambda rng: rng.normal(size=(300, 3)) * 0.03 + 1e4,
        lambda rng: rng.normal(size=(300, 3)) * [0.2, 0.0004, 0.0003],
    ],
    ids=["duplicates", "a heap at the centre", "corners", "tiny", "far away", "a wire"],
)
def test_odd_clouds_get_a_sane_answer(
    stage: PrimitiveRecovery, make: object, rng: np.random.Generator
) -> None:
    assert callable(make)
    points = make(rng)
    assert_sound(stage.recover(RecoverRequest(points=points)), points)


@settings(max_examples=25, deadline=None)
@given(
    st.integers(0, 2**32 - 1),
    st.integers(11, 400),
    st.tuples(*[st.floats(-4, 0)] * 3),
    st.sampled_from(["simulation", "real_world"]),
)
def test_any_cloud_is_answered_or_refused(
    stage: PrimitiveRecovery,
    seed: int,
    count: int,
    exponents: tuple[float, float, float],
    preset: Preset,
) -> None:
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(count, 3)) * 0.2 * np.power(10.0, exponents) + [0, 0, 0.8]
    try:
        response = stage.recover(RecoverRequest(points=points, preset=preset))
    except InvalidInput:
        return
    assert_sound(response, points)


@settings(max_examples=40, deadline=None)
@given(
    st.builds(
        EmsParameters,
        outlier_ratio=st.sampled_from([0.0, 0.5, 0.9999]),
        max_iterations=st.sampled_from([1, 10, 100]),
        tolerance=st.sampled_from([0.0, 1e-4, 1.0]),
        relative_tolerance=st.sampled_from([0.0, 0.5, 10.0]),
        max_switches=st.sampled_from([0, 1, 16]),
        adaptive_upper_bound=st.booleans(),
        eps=st.sampled_from([1e-4, 0.01, 1.0]),
        min_points=st.sampled_from([11, 100, 100_000]),
    ),
    st.integers(0, 2**32 - 1),
)
def test_any_parameters_give_sound_parts(
    stage: PrimitiveRecovery, parameters: EmsParameters, seed: int
) -> None:
    points = hammer(np.random.default_rng(seed))[::8]
    assert_sound(stage.recover(RecoverRequest(points=points, parameters=parameters)), points)
