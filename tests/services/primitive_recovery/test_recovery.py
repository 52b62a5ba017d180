"""One superquadric from one cloud."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from services.primitive_recovery.ems.recovery import Fit, recover_one
from shared.schemas.primitive import PRESETS, EmsParameters, Preset
from tests.services.primitive_recovery.clouds import (
    Array,
    overlap,
    random_superquadric,
    superquadric,
    surface_points,
)
from tests.services.primitive_recovery.singles import OVERLAP, SURFACE, trials

SIMULATION = PRESETS["simulation"]


def fit(points: Array, parameters: EmsParameters = SIMULATION, fit_points: int = 1000) -> Fit:
    return recover_one(points, parameters, np.zeros(3), fit_points, np.random.default_rng(0))


@pytest.fixture(scope="module")
def found() -> dict[str, Array]:
    """Errors (24, 8) per kind of cloud, over the whole range of shapes."""
    return trials(
        lambda points, _: fit(points).superquadric, ("noisy", "one view", "clutter"), "ems"
    )


@pytest.mark.parametrize(
    ("kind", "median_mm", "p90_mm", "median_overlap"),
    [("noisy", 1.0, 7.0, 0.95), ("one view", 2.0, 7.0, 0.38), ("clutter", 1.0, 4.5, 0.94)],
)
def test_all_shapes_are_recovered(
    found: dict[str, Array], kind: str, median_mm: float, p90_mm: float, median_overlap: float
) -> None:
    errors, overlaps = found[kind][:, [SURFACE, OVERLAP]].T
    assert np.median(errors) < median_mm
    assert np.percentile(errors, 90) < p90_mm
    assert np.median(overlaps) > median_overlap


def test_clutter_is_told_from_the_surface(rng: np.random.Generator) -> None:
    surface = surface_points(superquadric((0.3, 1.0), (0.04, 0.04, 0.1)), 800, rng)
    clutter = rng.uniform(-0.2, 0.2, (1200, 3))
    probability = fit(np.vstack([surface, clutter])).probability
    assert probability[:800].mean() > 0.9
    assert probability[800:].mean() < 0.2


def test_parameters_of_a_clean_can(rng: np.random.Generator) -> None:
    can = superquadric((0.1, 1.0), (0.033, 0.033, 0.06), (0.1, -0.05, 0.8))
    found = fit(surface_points(can, 2000, rng)).superquadric
    np.testing.assert_allclose(sorted(found.semi_axes), [0.033, 0.033, 0.06], atol=0.002)
    np.testing.assert_allclose(found.position, can.position, atol=0.001)
    assert overlap(can, found, rng) > 0.97


@pytest.mark.parametrize("noise", [1e-5, 3e-4])
@pytest.mark.parametrize("preset", ["simulation", "real_world"])
def test_a_sheet_becomes_a_thin_slab_behind_it(
    noise: float, preset: Preset, rng: np.random.Generator
) -> None:
    sheet = rng.uniform(-1.0, 1.0, (3000, 3)) * [0.05, 0.03, 0.0] + [0.0, 0.0, 0.8]
    sheet[:, 2] += noise * rng.normal(size=3000)
    found = fit(sheet, PRESETS[preset]).superquadric
    thin, short, long = sorted(found.full_extents)
    assert thin < 0.01
    assert short == pytest.approx(0.06, rel=0.35)
    assert long == pytest.approx(0.1, rel=0.2)
    assert found.position[2] > 0.8  # the sensor is at the origin


def test_the_same_numbers_every_time(rng: np.random.Generator) -> None:
    points = surface_points(random_superquadric(rng), 3000, rng)
    first, again = fit(points), fit(points)
    assert first.superquadric == again.superquadric
    np.testing.assert_array_equal(first.probability, again.probability)


def test_drawing_fewer_points_changes_little(rng: np.random.Generator) -> None:
    body = superquadric((0.3, 0.9), (0.04, 0.06, 0.1))
    points = surface_points(body, 6000, rng) + 0.001 * rng.normal(size=(6000, 3))
    assert overlap(fit(points, fit_points=6000).superquadric,
                   fit(points, fit_points=1000).superquadric, rng) > 0.95  # fmt: skip


CHANGED: dict[str, Any] = {
    "outlier_ratio": 0.2,
    "max_iterations": 3,
    "tolerance": 1e6,
    "relative_tolerance": -1e9,
    "max_switches": 0,
    "adaptive_upper_bound": True,
}


@pytest.mark.parametrize("name", CHANGED)
def test_every_parameter_of_the_fit_does_something(name: str) -> None:
    rng = np.random.default_rng(3)
    body = superquadric((0.2, 1.6), (0.03, 0.05, 0.12), (0.0, 0.0, 0.8))
    points = surface_points(body, 1500, rng, one_view=True)
    points += 0.002 * rng.normal(size=points.shape)
    changed = SIMULATION.model_copy(update={name: CHANGED[name]})
    assert fit(points, changed).superquadric != fit(points).superquadric
