"""Each kernel against a NumPy reference or against differences."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from services.primitive_recovery.ems.kernels import turned
from services.primitive_recovery.fitting.gauge import log_gauge
from services.primitive_recovery.fitting.terms import (
    AT_LEAST,
    AT_MOST,
    EQUAL,
    point_terms,
    prior_terms,
    support_row,
    support_terms,
)
from shared.superquadric import Superquadric, inside_outside, surface_mesh
from tests.services.primitive_recovery.fitting.scenes import Array

State = tuple[Array, Array, Array]


def state(seed: int) -> State:
    rng = np.random.default_rng(seed)
    shape = np.array([*rng.uniform(0.2, 1.6, 2), *np.log(rng.uniform(0.2, 1.0, 3))])
    rotation = np.ascontiguousarray(Rotation.from_quat(rng.normal(size=4)).as_matrix())
    return shape, rotation, rng.uniform(-0.2, 0.2, 3)


def moved(one: State, step: Array) -> State:
    return one[0] + step[:5], turned(one[1], step[5:8].copy()), one[2] + step[8:]


def solid(one: State) -> Superquadric:
    shape, rotation, position = one
    quaternion = Rotation.from_matrix(rotation).as_quat()
    return Superquadric.from_vector([*shape[:2], *np.exp(shape[2:]), *position, *quaternion])


@pytest.mark.parametrize("seed", range(6))
def test_the_gauge_is_the_inside_outside_function(seed: int) -> None:
    one = state(seed)
    points = np.random.default_rng(seed).normal(size=(50, 3))
    thing = solid(one)
    logs = np.log(np.abs(thing.to_local(points)) / thing.semi_axes)
    e1, e2 = thing.exponents
    found = [log_gauge(x, y, z, e1, e2)[0] for x, y, z in logs]
    np.testing.assert_allclose(found, e1 / 2 * np.log(inside_outside(thing, points)), atol=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_the_derivatives_of_the_gauge(seed: int) -> None:
    rng = np.random.default_rng(seed)
    arguments = np.array([*rng.normal(size=3), *rng.uniform(0.2, 1.9, 2)])
    h = 1e-6
    differences = [
        (log_gauge(*(arguments + h * e))[0] - log_gauge(*(arguments - h * e))[0]) / (2 * h)
        for e in np.eye(5)
    ]
    np.testing.assert_allclose(log_gauge(*arguments)[1:], differences, atol=1e-6)


def radial(one: State, points: Array) -> Array:
    thing = solid(one)
    length = np.linalg.norm(thing.to_local(points), axis=1)
    return np.asarray(length * (1 - inside_outside(thing, points) ** (-thing.exponents[0] / 2)))


@pytest.mark.parametrize("seed", range(4))
def test_points_weigh_as_their_distance_proper_and_robustly(seed: int) -> None:
    one, width, share, h = state(seed), 0.1, 3.0, 1e-6
    points = np.random.default_rng(seed).normal(size=(80, 3)) * 0.5
    distances = radial(one, points)
    jacobian = np.column_stack(
        [(radial(moved(one, h * e), points) - radial(moved(one, -h * e), points)) / (2 * h)
         for e in np.eye(11)]
    )  # fmt: skip
    # The normal is along the gradient of F, hence of log F^(e1/2): differences again.
    thing = solid(one)
    log_f = [
        np.log(inside_outside(thing, points + h * e) / inside_outside(thing, points - h * e))
        for e in np.eye(3)
    ]
    normal = np.stack(log_f, axis=1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    ray = points - one[2]
    ray /= np.linalg.norm(ray, axis=1, keepdims=True)
    cosine = np.einsum("ij,ij->i", normal, ray)
    ratio = (distances * cosine / width) ** 2
    robust = np.where(distances > 0, 1 / (1 + ratio), 1 / (1 + ratio) ** 2)
    loss = np.where(distances > 0, np.log1p(ratio), ratio / (1 + ratio))
    weights = share * robust * cosine**2
    matrix, gradient = np.zeros((11, 11)), np.zeros(11)
    cost = point_terms(points, *one, width, share, matrix, gradient)
    assert cost == pytest.approx(0.5 * share * width**2 * loss.sum(), rel=1e-6)
    np.testing.assert_allclose(gradient, jacobian.T @ (weights * distances), atol=1e-4, rtol=1e-3)
    full = (jacobian.T * weights) @ jacobian
    np.testing.assert_allclose(matrix, np.tril(full), atol=1e-3, rtol=1e-3)


@pytest.mark.parametrize("seed", range(8))
def test_a_support_is_the_farthest_point_of_the_body(seed: int) -> None:
    one = state(seed)
    vertices = surface_mesh(solid(one), 300, 600)[0]
    for direction in np.random.default_rng(seed).normal(size=(5, 3)):
        m = direction / np.linalg.norm(direction)
        row = np.empty(11)
        found = support_row(m, *one, row)
        assert found == pytest.approx((vertices @ m).max(), abs=2e-3)
        h = 1e-6
        scratch = np.empty(11)
        differences = [
            (support_row(m, *moved(one, h * e), scratch)
             - support_row(m, *moved(one, -h * e), scratch)) / (2 * h)
            for e in np.eye(11)
        ]  # fmt: skip
        np.testing.assert_allclose(row, differences, atol=1e-5)


@pytest.mark.parametrize("says", [EQUAL, AT_LEAST, AT_MOST])
def test_a_support_pushes_only_where_it_is_violated(says: float) -> None:
    one = (np.array([1.0, 1.0, 0.0, 0.0, 0.0]), np.eye(3), np.zeros(3))  # the unit ball
    for plane, short in ((1.2, True), (0.8, False)):
        matrix, gradient = np.zeros((11, 11)), np.zeros(11)
        rows = np.array([[0.0, 0.0, 1.0, plane, 0.1, says]])
        cost = support_terms(rows, *one, matrix, gradient)
        pushes = says == EQUAL or (says == AT_LEAST) == short
        assert (cost > 0) == pushes
        if pushes:
            assert (gradient[4] < 0) == short  # a longer axis reaches a plane that is beyond


@pytest.mark.parametrize("seed", range(4))
def test_the_gradient_of_the_priors(seed: int) -> None:
    one = state(seed)
    start = turned(one[1], np.array([1e-3, -2e-3, 1.5e-3]))
    prior = np.array([0.4, 0.8, 0.5, 0.2, -0.5, 3.0, 0.3, 0.1, 0.2])

    def cost(step: Array) -> float:
        shape, rotation, _ = moved(one, step)
        return prior_terms(prior, start, shape, rotation, np.zeros((11, 11)), np.zeros(11))

    gradient = np.zeros(11)
    prior_terms(prior, start, one[0], one[1], np.zeros((11, 11)), gradient)
    h = 1e-6
    differences = [(cost(h * e) - cost(-h * e)) / (2 * h) for e in np.eye(11)]
    np.testing.assert_allclose(gradient, differences, atol=2e-3, rtol=1e-2)


def test_extreme_shapes_stay_finite() -> None:
    points = np.vstack([np.eye(3), np.zeros((1, 3)), 1e6 * np.eye(3), 1e-9 * np.eye(3)])
    for exponents in ((0.1, 0.1), (2.0, 2.0), (0.1, 2.0)):
        one = (np.array([*exponents, np.log(1e-3), 0.0, 1.0]), np.eye(3), np.zeros(3))
        matrix, gradient = np.zeros((11, 11)), np.zeros(11)
        cost = point_terms(points, *one, 0.1, 1.0, matrix, gradient)
        rows = np.hstack([np.eye(3), np.ones((3, 1)), np.full((3, 1), 0.1), np.zeros((3, 1))])
        cost += support_terms(rows, *one, matrix, gradient)
        assert np.isfinite(cost)
        assert np.isfinite(matrix).all()
        assert np.isfinite(gradient).all()
