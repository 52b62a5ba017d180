"""EMS in its published form: a superquadric with a known answer, and the table of times."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from experiments.primitives.model import METHODS, Cut
from experiments.primitives.published import (
    PublishedFit,
    distances,
    published_fit,
    published_kept,
    published_parts,
)
from experiments.primitives.reference import ReferenceTime, reference_table
from shared.superquadric import Superquadric, radial_distance, surface_mesh


def cloud(body: Superquadric, count: int, rng: np.random.Generator) -> np.ndarray:
    """Return points (count, 3) on the triangles of a body, 0.5 mm of noise."""
    vertices, faces = surface_mesh(body)
    corners = vertices[faces]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    chosen = rng.choice(len(faces), count, p=area / area.sum())
    weights = rng.dirichlet([1.0, 1.0, 1.0], count)
    on_it = np.einsum("nk,nkj->nj", weights, corners[chosen])
    return np.asarray(on_it + rng.normal(0, 5e-4, on_it.shape))


@pytest.fixture
def can() -> Superquadric:
    turn = Rotation.from_euler("ZYX", [0.4, 0.7, -0.2]).as_quat()
    return Superquadric.from_vector([0.2, 1.0, 0.035, 0.035, 0.08, 0.1, -0.2, 0.9, *turn])


def test_distances_are_the_radial_ones(can: Superquadric, rng: np.random.Generator) -> None:
    points = rng.normal(size=(50, 3)) * 0.1 + can.position
    values = np.array([0.2, 1.0, 0.035, 0.035, 0.08, 0.4, 0.7, -0.2, 0.1, -0.2, 0.9])
    np.testing.assert_allclose(
        distances(points, values), np.abs(radial_distance(can, points)), rtol=1e-4, atol=1e-6
    )


def test_it_finds_a_can_among_outliers(can: Superquadric, rng: np.random.Generator) -> None:
    clutter = can.position + rng.uniform(-0.12, 0.12, (400, 3))
    fit = published_fit(np.vstack([cloud(can, 1200, rng), clutter]))
    np.testing.assert_allclose(np.sort(fit.values[2:5]), [0.035, 0.035, 0.08], rtol=0.1)
    np.testing.assert_allclose(fit.values[8:], can.position, atol=0.005)
    assert fit.inlier[:1200].mean() > 0.8
    assert fit.inlier[1200:].mean() < 0.3


def test_what_one_leaves_over_gets_its_own(can: Superquadric, rng: np.random.Generator) -> None:
    other = Superquadric.from_vector(
        [1.0, 1.0, 0.03, 0.03, 0.03, 0.1, 0.0, 0.9, 0.0, 0.0, 0.0, 1.0]
    )
    parts = published_parts(np.vstack([cloud(can, 6000, rng), cloud(other, 3000, rng)]))
    ball = min(parts, key=lambda part: float(np.linalg.norm(part.values[8:] - other.position)))
    np.testing.assert_allclose(ball.values[8:], other.position, atol=0.01)
    np.testing.assert_allclose(ball.values[2:5], 0.03, atol=0.006)


def ball(x: float, radius: float) -> PublishedFit:
    return PublishedFit(
        np.array([1.0, 1.0, radius, radius, radius, 0.3, 0.2, 0.1, x, 0.0, 0.8]), np.ones(1)
    )


def test_the_one_that_overlaps_more_goes() -> None:
    large, within, apart = ball(0.0, 0.05), ball(0.01, 0.04), ball(0.07, 0.04)
    assert published_kept([within, large, apart]) == [large, apart]


def test_the_table_compares_the_same_views() -> None:
    def cut(view: str, method: str, seconds: float | None) -> Cut:
        return Cut("scans", "mug", "mug", view, method, method, (), seconds=seconds)  # type: ignore[arg-type]

    cuts = [cut("1", method, spent) for method, spent in zip(METHODS, (0.01, 0.05), strict=True)]
    cuts += [cut("2", METHODS[0], 9.0), cut("2", METHODS[1], None)]
    times = [
        ReferenceTime("scans", "mug", "1", 3000, 0.5),
        ReferenceTime("scans", "mug", "2", 9000, 7.0),  # one method failed
    ]
    (row,) = reference_table(times, cuts).rows
    assert row[:3] == ("scans", 1, 3000)
    assert list(row[3:]) == [pytest.approx(each) for each in (10, 50, 500, 50, 10)]
