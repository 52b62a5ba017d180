"""Each kernel against a NumPy reference."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from services.primitive_recovery.ems.kernels import normal_equations, radial_distances, turned
from shared.superquadric import Superquadric, inside_outside, radial_distance
from tests.services.primitive_recovery.clouds import Array, random_superquadric


def arrays(body: Superquadric) -> tuple[Array, Array, Array]:
    shape = np.array([*body.exponents, *body.semi_axes])
    return shape, np.ascontiguousarray(body.rotation), np.array(body.position)


def moved(body: Superquadric, step: Array) -> Superquadric:
    rotation = Rotation.from_matrix(body.rotation) * Rotation.from_rotvec(step[5:8])
    return Superquadric.from_vector(
        [
            *(np.array(body.exponents) + step[:2]),
            *(np.array(body.semi_axes) + step[2:5]),
            *(np.array(body.position) + step[8:]),
            *rotation.as_quat(),
        ]
    )


def reference(body: Superquadric, points: Array) -> Array:
    """The radial distance as its formula stands."""
    length = np.linalg.norm(body.to_local(points), axis=1)
    return np.asarray(length * (1 - inside_outside(body, points) ** (-body.exponents[0] / 2)))


@pytest.mark.parametrize("seed", range(8))
def test_the_distance_is_the_formula_and_the_shared_one(seed: int) -> None:
    rng = np.random.default_rng(seed)
    body = random_superquadric(rng)
    points = np.vstack(
        [
            rng.normal(size=(300, 3)) * 0.05 + body.position,
            body.to_outer(np.diag(body.semi_axes)),  # where the axes meet the surface
            [[50.0, 0.0, 0.0]],
        ]
    )
    found = radial_distances(points, *arrays(body))
    np.testing.assert_allclose(found, radial_distance(body, points), rtol=1e-9, atol=1e-12)
    formula = np.maximum(reference(body, points[:300]), -min(body.semi_axes))
    np.testing.assert_allclose(found[:300], formula, rtol=1e-7, atol=1e-10)
    np.testing.assert_allclose(found[300:303], 0.0, atol=1e-9)


def test_the_centre_is_inside(rng: np.random.Generator) -> None:
    body = random_superquadric(rng)
    (found,) = radial_distances(np.array([body.position]), *arrays(body))
    assert found == -min(body.semi_axes)


@pytest.mark.parametrize("exponents", [(0.1, 0.1), (2.0, 2.0), (0.1, 2.0), (2.0, 0.1)])
def test_extreme_exponents_stay_finite(
    exponents: tuple[float, float], rng: np.random.Generator
) -> None:
    shape = np.array([*exponents, 10.0, 0.01, 1.0])
    points = np.vstack([rng.normal(size=(50, 3)), np.eye(3), 1e6 * np.eye(3), np.zeros((1, 3))])
    position = np.zeros(3)
    assert np.isfinite(radial_distances(points, shape, np.eye(3), position)).all()
    for part in normal_equations(points, np.ones(len(points)), shape, np.eye(3), position):
        assert np.isfinite(part).all()


@pytest.mark.parametrize("seed", range(6))
def test_the_normal_equations_hold_the_derivatives_of_the_distance(seed: int) -> None:
    rng = np.random.default_rng(100 + seed)
    body = random_superquadric(rng)
    points = rng.normal(size=(200, 3)) * 0.08 + body.position
    weights = rng.uniform(0.0, 1.0, 200)
    h = 1e-6
    distances = reference(body, points)
    jacobian = np.column_stack(
        [
            (reference(moved(body, h * e), points) - reference(moved(body, -h * e), points))
            / (2 * h)
            for e in np.eye(11)
        ]
    )
    cost, gradient, matrix = normal_equations(points, weights, *arrays(body))
    assert cost == pytest.approx(0.5 * (weights * distances**2).sum())
    np.testing.assert_allclose(gradient, jacobian.T @ (weights * distances), atol=2e-5, rtol=1e-4)
    np.testing.assert_allclose(matrix, (jacobian.T * weights) @ jacobian, atol=2e-4, rtol=1e-4)


@pytest.mark.parametrize("vector", [(0.3, -0.8, 1.1), (0.0, 0.0, 0.0), (1e-8, 0.0, -2e-8)])
def test_a_turn_is_a_rotation_vector(vector: tuple[float, float, float]) -> None:
    rotation = Rotation.from_euler("xyz", [0.4, 1.2, -2.0])
    expected = (rotation * Rotation.from_rotvec(vector)).as_matrix()
    start = np.ascontiguousarray(rotation.as_matrix())
    np.testing.assert_allclose(turned(start, np.array(vector)), expected, atol=1e-15)
