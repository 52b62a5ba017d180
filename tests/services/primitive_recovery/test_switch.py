from __future__ import annotations

import numpy as np
import pytest

from services.primitive_recovery.ems.bounds import Bounds
from services.primitive_recovery.ems.state import State
from services.primitive_recovery.ems.switch import similar_states, switch
from shared.geometry.rotation import quaternion_from_matrix
from shared.superquadric import Superquadric, volume
from tests.services.primitive_recovery.clouds import overlap, superquadric, surface_points

WIDE = Bounds.of(np.full(3, 20.0), np.full(3, 20.0))


def state(e1: float, e2: float, a1: float, a2: float, a3: float) -> State:
    return State(np.array([e1, e2, a1, a2, a3]), np.eye(3), np.array([0.1, 0.2, 0.3]))


def body(one: State) -> Superquadric:
    return Superquadric.from_vector(
        [*one.shape, *one.position, *quaternion_from_matrix(one.rotation)]
    )


def test_frames_stay_right_handed_rotations() -> None:
    for one in similar_states(state(0.4, 0.7, 5.0, 4.5, 4.8)):
        np.testing.assert_allclose(one.rotation @ one.rotation.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(one.rotation) == pytest.approx(1.0)
        assert 0.1 <= one.shape[:2].min() <= one.shape[:2].max() <= 2.0


def test_permutations_of_an_ellipsoid_are_the_same_body(rng: np.random.Generator) -> None:
    ellipsoid = state(1.0, 1.0, 9.0, 5.0, 2.0)
    permuted = similar_states(ellipsoid)
    assert len(permuted) == 2  # no two semi-axes are alike: no duals
    for one in permuted:
        assert overlap(body(ellipsoid), body(one), rng) > 0.999


@pytest.mark.parametrize("e2", [0.1, 0.5, 1.0, 1.5, 1.9])
def test_the_dual_of_a_square_cross_section_is_nearly_the_same_body(
    e2: float, rng: np.random.Generator
) -> None:
    prism = state(0.2, e2, 4.0, 4.0, 9.0)
    (dual,) = similar_states(prism)[2:]
    assert dual.shape[1] == pytest.approx(2 - e2)
    assert overlap(body(prism), body(dual), rng) > 0.95
    assert volume(body(dual)) == pytest.approx(volume(body(prism)), rel=0.05)


def test_alike_axes_give_a_dual_each() -> None:
    assert len(similar_states(state(0.5, 0.5, 5.0, 5.0, 5.0))) == 5


def test_a_cylinder_that_was_fitted_across_its_axis_is_turned(rng: np.random.Generator) -> None:
    points = surface_points(superquadric((0.1, 1.0), (3.0, 3.0, 9.0)), 1500, rng)
    across = State(
        np.array([1.0, 0.3, 9.0, 3.0, 3.0]),
        np.ascontiguousarray(np.eye(3)[:, [2, 0, 1]]),
        np.zeros(3),
    )
    weights = np.ones(len(points))
    cost = float((across.distances(points) ** 2).mean())
    better = switch(points, weights, across, cost, WIDE)
    assert better is not None
    assert better[1] < cost


def test_nothing_beats_a_perfect_fit(rng: np.random.Generator) -> None:
    points = surface_points(superquadric((0.2, 1.0), (3.0, 3.0, 9.0)), 500, rng)
    assert switch(points, np.ones(500), state(0.2, 1.0, 3.0, 3.0, 9.0), 0.0, WIDE) is None
