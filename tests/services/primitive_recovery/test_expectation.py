from __future__ import annotations

import numpy as np
import pytest

from services.primitive_recovery.ems.expectation import inlier_probability


def test_it_is_bayes_rule_for_a_gaussian_shell_in_uniform_clutter() -> None:
    distances, variance, ratio, volume = np.array([0.0, 0.5, -1.0, 3.0]), 0.3, 0.9, 200.0
    density = (2 * np.pi * variance) ** -1.5 * np.exp(-(distances**2) / (2 * variance))
    expected = (1 - ratio) * density / ((1 - ratio) * density + ratio / volume)
    found = inlier_probability(distances, variance, ratio, volume)
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_without_outliers_all_are_inliers_however_far() -> None:
    found = inlier_probability(np.array([0.0, 1e3]), 0.3, 0.0, 1.0)
    np.testing.assert_array_equal(found, 1.0)


@pytest.mark.parametrize("variance", [1e-6, 0.3, 1e3])
def test_farther_is_never_likelier(variance: float) -> None:
    found = inlier_probability(np.linspace(0, 1e4, 1000), variance, 0.965, 500.0)
    assert (np.diff(found) <= 0).all()
    assert ((found >= 0) & (found <= 1)).all()
