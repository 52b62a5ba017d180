"""The implicit function, the radial distance, surface and volume agree with each other."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shared.superquadric import (
    Superquadric,
    inside_outside,
    radial_distance,
    surface_mesh,
    volume,
)

exponent = st.floats(0.1, 2.0)
semi_axis = st.floats(0.005, 0.3)
superquadrics = st.builds(
    lambda e, a, t, q: Superquadric.from_vector([*e, *a, *t, *q]),
    st.tuples(exponent, exponent),
    st.tuples(semi_axis, semi_axis, semi_axis),
    st.tuples(*[st.floats(-1, 1)] * 3),
    st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1),
)


@given(superquadrics)
def test_the_mesh_lies_on_the_surface(superquadric: Superquadric) -> None:
    vertices, _ = surface_mesh(superquadric)
    np.testing.assert_allclose(inside_outside(superquadric, vertices), 1, rtol=1e-6)
    assert np.abs(radial_distance(superquadric, vertices)).max() < 1e-9


@given(superquadrics, st.floats(0.2, 3.0))
def test_the_radial_distance_is_measured_along_the_ray(
    superquadric: Superquadric, factor: float
) -> None:
    vertices, _ = surface_mesh(superquadric, 4, 8)
    centre = np.asarray(superquadric.position)
    scaled = centre + factor * (vertices - centre)
    expected = (factor - 1) * np.linalg.norm(vertices - centre, axis=1)
    floor = -min(superquadric.semi_axes)
    np.testing.assert_allclose(
        radial_distance(superquadric, scaled), np.maximum(expected, floor), atol=1e-9
    )


@given(superquadrics)
def test_the_centre_is_inside(superquadric: Superquadric) -> None:
    centre = np.array([superquadric.position])
    assert inside_outside(superquadric, centre)[0] < 1
    assert radial_distance(superquadric, centre)[0] < 0


@pytest.mark.parametrize("exponents", [(1, 1), (0.5, 1.2), (2, 2), (0.3, 0.3)])
def test_volume_agrees_with_the_mesh(exponents: tuple[float, float]) -> None:
    superquadric = Superquadric(exponents, (0.1, 0.05, 0.2), (1, 2, 3), (0.5, 0.5, 0.5, 0.5))
    vertices, faces = surface_mesh(superquadric, 96, 192)
    corners = (vertices - np.asarray(superquadric.position))[faces]
    meshed = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert meshed == pytest.approx(volume(superquadric), rel=5e-3)


def test_a_ball_and_nearly_a_box() -> None:
    ball = Superquadric((1, 1), (0.1, 0.1, 0.1), (0, 0, 0), (0, 0, 0, 1))
    assert volume(ball) == pytest.approx(4 / 3 * np.pi * 1e-3)
    box = Superquadric((0.1, 0.1), (0.1, 0.2, 0.3), (0, 0, 0), (0, 0, 0, 1))
    assert volume(box) == pytest.approx(8 * 0.1 * 0.2 * 0.3, rel=0.03)
    assert box.full_extents == (0.2, 0.4, 0.6)


def test_the_mesh_is_closed() -> None:
    ball = Superquadric((1, 1), (0.1, 0.1, 0.1), (0, 0, 0), (0, 0, 0, 1))
    vertices, faces = surface_mesh(ball, 5, 7)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    forward = set(map(tuple, edges.tolist()))
    assert len(forward) == len(edges)
    assert forward == {(b, a) for a, b in forward}
    assert len(vertices) - len(edges) // 2 + len(faces) == 2


def test_vector_round_trip() -> None:
    vector = [0.5, 1.0, 0.1, 0.2, 0.3, 1.0, 2.0, 3.0, 0.0, 0.0, 0.6, 0.8]
    np.testing.assert_array_equal(Superquadric.from_vector(vector).to_vector(), vector)
