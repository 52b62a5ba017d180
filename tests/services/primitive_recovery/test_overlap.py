from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from services.primitive_recovery.ems.overlap import (
    kept_after_overlap,
    overlap_shares,
    volume_samples,
)
from shared.superquadric import Superquadric, inside_outside, volume
from tests.services.primitive_recovery.clouds import random_superquadric, superquadric


def ball(radius: float, x: float = 0.0) -> Superquadric:
    return superquadric((1.0, 1.0), (radius, radius, radius), (x, 0.0, 0.8))


def kept(*bodies: Superquadric) -> tuple[int, ...]:
    return kept_after_overlap(bodies)


def test_a_part_inside_another_goes() -> None:
    assert kept(ball(0.05), ball(0.02, 0.01)) == (0,)
    assert kept(ball(0.02, 0.01), ball(0.05)) == (1,)


def test_apart_or_touching_both_stay() -> None:
    assert kept(ball(0.05), ball(0.05, 0.2)) == (0, 1)
    assert kept(ball(0.05), ball(0.05, 0.09)) == (0, 1)


def test_where_both_overlap_by_more_than_half_the_smaller_goes() -> None:
    # The thesis' example: the larger share is the smaller body's.
    assert kept(ball(0.05), ball(0.048, 0.005)) == (0,)
    assert kept(ball(0.048, 0.005), ball(0.05)) == (1,)


def test_of_two_alike_the_first_stays() -> None:
    assert kept(ball(0.05), ball(0.05), ball(0.05)) == (0,)


def test_a_part_that_is_partly_inside_stays_while_less_than_half() -> None:
    rod = superquadric((0.1, 1.0), (0.01, 0.01, 0.1), (0.0, 0.0, 0.8))
    assert kept(rod, superquadric((1.0, 1.0), (0.03, 0.03, 0.03), (0.0, 0.0, 0.9))) == (0, 1)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 4))
def test_the_largest_always_stays(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    bodies = [random_superquadric(rng) for _ in range(count)]
    assert int(np.argmax([volume(one) for one in bodies])) in kept(*bodies)


@pytest.mark.parametrize("exponents", [(0.1, 0.1), (1.0, 1.0), (2.0, 2.0), (0.1, 2.0)])
def test_samples_fill_the_volume_evenly(
    exponents: tuple[float, float],
) -> None:
    body = superquadric(exponents, (0.02, 0.05, 0.1), (0.1, 0.2, 0.9), (0.5, 0.5, 0.5, 0.5))
    samples = volume_samples(body, 4000)
    assert samples.shape == (4000, 3)
    assert (inside_outside(body, samples) < 1).all()
    half = superquadric(exponents, (0.01, 0.025, 0.05), body.position, body.quaternion)
    assert (inside_outside(half, samples) < 1).mean() == pytest.approx(1 / 8, abs=0.005)


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_shares_are_those_of_many_random_points(seed: int) -> None:
    rng = np.random.default_rng(seed)
    body, other = (random_superquadric(rng) for _ in range(2))
    shift = np.array(body.position) + rng.uniform(-0.5, 0.5, 3) * body.semi_axes
    other = superquadric(other.exponents, other.semi_axes, tuple(shift), other.quaternion)
    cube = rng.uniform(-1.0, 1.0, (60_000, 3)) * body.semi_axes
    points = body.to_outer(cube)
    points = points[inside_outside(body, points) < 1]
    expected = (inside_outside(other, points) < 1).mean()
    share = overlap_shares([body, other])
    assert share[0, 0] == 1.0
    assert share[0, 1] == pytest.approx(expected, abs=0.02)
    # Both rows measure the same intersection.
    assert share[0, 1] * volume(body) == pytest.approx(
        share[1, 0] * volume(other), rel=0.1, abs=0.02 * min(volume(body), volume(other))
    )
