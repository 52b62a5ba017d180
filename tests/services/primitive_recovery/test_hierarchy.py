from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from services.primitive_recovery.ems.hierarchy import MAX_SUPERQUADRICS, Part, decompose
from shared.schemas.primitive import PRESETS
from tests.services.primitive_recovery.clouds import (
    Array,
    hammer,
    overlap,
    superquadric,
    surface_points,
)


def parts(points: Array, **changes: Any) -> list[Part]:
    parameters = PRESETS["simulation"].model_copy(update=changes)
    return decompose(points, parameters, np.zeros(3), 1000, np.random.default_rng(0))


def test_one_body_is_one_part(rng: np.random.Generator) -> None:
    points = surface_points(superquadric((0.3, 1.0), (0.03, 0.03, 0.05)), 2000, rng)
    (part,) = parts(points)
    assert part.support > 1900
    assert part.residual < 0.001


def test_a_hammer_is_several_parts_largest_first(rng: np.random.Generator) -> None:
    found = parts(hammer(rng))
    assert 2 <= len(found) <= MAX_SUPERQUADRICS
    supports = [part.support for part in found]
    assert supports == sorted(supports, reverse=True)
    assert sum(supports) <= 4000


def test_never_more_than_four(rng: np.random.Generator) -> None:
    balls = [
        surface_points(
            superquadric((1.0, 1.0), (0.02, 0.02, 0.02), (0.1 * x, 0.1 * y, 0.8)), 1500, rng
        )
        for x in range(3)
        for y in range(2)
    ]
    found = parts(np.vstack(balls))
    assert len(found) == MAX_SUPERQUADRICS


def test_min_points_and_eps_decide_what_is_fitted_again(rng: np.random.Generator) -> None:
    points = hammer(rng)
    assert len(parts(points)) > 1
    assert len(parts(points, min_points=3000)) == 1
    assert len(parts(points, eps=1e-5)) == 1


def test_the_parts_move_with_the_points(rng: np.random.Generator) -> None:
    points = hammer(rng)
    rotation = Rotation.from_rotvec([0.4, -0.9, 0.3])
    shift = np.array([0.2, 0.1, 0.3])
    here = parts(points)
    parameters = PRESETS["simulation"]
    there = decompose(
        np.ascontiguousarray(rotation.apply(points) + shift),
        parameters,
        shift,  # the sensor moves along
        1000,
        np.random.default_rng(0),
    )
    assert [part.support for part in there] == [part.support for part in here]
    for a, b in zip(here, there, strict=True):
        np.testing.assert_allclose(
            b.superquadric.semi_axes, a.superquadric.semi_axes, rtol=1e-4, atol=1e-6
        )
        expected = rotation.apply(a.superquadric.position) + shift
        np.testing.assert_allclose(b.superquadric.position, expected, atol=1e-5)


def test_a_larger_copy_is_a_larger_superquadric(rng: np.random.Generator) -> None:
    points = surface_points(superquadric((0.4, 0.9), (0.02, 0.03, 0.06)), 1500, rng)
    (small,), (large,) = parts(points), parts(3 * points)
    np.testing.assert_allclose(
        large.superquadric.semi_axes, 3 * np.array(small.superquadric.semi_axes), rtol=1e-6
    )
    assert overlap(large.superquadric, small.superquadric, rng) < 0.1
