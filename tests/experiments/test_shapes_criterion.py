"""The criterion that names superquadrics, and the overlaps it rests on."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from experiments.shapes.criterion import (
    ALIKE,
    CLASSES,
    looks_round,
    name,
    names,
    perceived,
    superellipse_area,
)
from experiments.shapes.dataset import (
    EXPONENTS,
    SEMI_AXES,
    random_superquadrics,
    thesis_superquadrics,
)
from experiments.shapes.overlap import overlaps
from shared.superquadric import Superquadric, volume


@pytest.mark.parametrize(
    ("expected", "parameters"),
    [
        ("cuboid", (0.1, 0.1, 0.03, 0.05, 0.1)),
        ("cuboid", (0.1, 2.0, 0.05, 0.05, 0.1)),  # turned by 45 degrees
        ("cuboid", (1.2, 0.1, 0.05, 0.06, 0.08)),  # its cross-section is square
        ("cylinder", (0.1, 1.0, 0.03, 0.05, 0.1)),
        ("cylinder", (1.0, 0.1, 0.1, 0.03, 0.03)),  # a rod along its x
        ("cylinder", (1.0, 1.0, 0.02, 0.02, 0.1)),  # a cigar
        ("sphere", (1.0, 1.0, 0.05, 0.05, 0.06)),
        ("sphere", (0.9, 1.2, 0.05, 0.05, 0.06)),
    ],
)
def test_textbook_bodies_have_their_names(expected: str, parameters: tuple[float, ...]) -> None:
    assert CLASSES[name(np.array(parameters))] == expected


def test_an_ideal_body_overlaps_itself() -> None:
    assert overlaps(np.array([0.1, 0.1, 0.3, 0.2, 0.1])).box > 0.95
    assert overlaps(np.array([0.1, 1.0, 0.3, 0.2, 0.1])).cylinder > 0.95
    assert overlaps(np.array([1.0, 1.0, 0.2, 0.2, 0.2])).ball > 0.95


def test_overlaps_of_a_unit_ball_are_those_of_geometry() -> None:
    ball = overlaps(np.array([1.0, 1.0, 1.0, 1.0, 1.0]))
    # The best cylinder in or about a ball is not simpler than a search; a finer one does it here.
    radius, height = (
        axis.ravel() for axis in np.meshgrid(*[np.linspace(0.5, 1, 51)] * 2, indexing="ij")
    )
    slices = np.linspace(0, 1, 401)[:-1] + 0.00125
    within = np.minimum(radius[:, None] ** 2, 1 - slices**2) * (slices < height[:, None])
    shared = np.pi * within.mean(axis=1)
    best = (shared / (2 * np.pi / 3 + np.pi * radius**2 * height - shared)).max()
    assert ball.cylinder == pytest.approx(best, abs=0.01)
    assert ball.lying_cylinder == pytest.approx(ball.cylinder, abs=0.01)


def test_a_rhombus_column_is_less_of_a_box_than_a_square_one() -> None:
    square = overlaps(np.array([0.1, 2.0, 0.1, 0.1, 0.1])).box
    assert overlaps(np.array([0.1, 2.0, 0.1, 0.04, 0.1])).box < square - 0.1


def test_equal_bodies_have_equal_overlaps(rng: np.random.Generator) -> None:
    for e1, e2, a1, a2, a3 in random_superquadrics(30, rng):
        here = overlaps(np.array([e1, e2, a1, a2, a3]))
        for other in ([e1, e2, a2, a1, a3], [e1, e2, 7 * a1, 7 * a2, 7 * a3]):
            there = overlaps(np.array(other))
            assert there.box == pytest.approx(here.box, rel=1e-9)
            assert there.cylinder == pytest.approx(here.cylinder, rel=1e-9)
            assert there.ball == pytest.approx(here.ball, rel=1e-9)


@given(st.floats(0.1, 2.0))
def test_the_area_is_that_of_a_flat_superquadric(exponent: float) -> None:
    # With e1 -> 0 a superquadric is its cross-section times its height.
    column = Superquadric((1e-6, exponent), (1, 1, 0.5), (0, 0, 0), (0, 0, 0, 1))
    assert superellipse_area(exponent) == pytest.approx(volume(column), rel=1e-4)


def test_what_looks_round() -> None:
    assert [looks_round(each) for each in (0.1, 0.6, 0.7, 1.0, 1.3, 1.4, 2.0)] == [
        False, False, True, True, True, False, False,
    ]  # fmt: skip


def test_alike_is_where_an_ellipse_meets_its_circle_as_a_circle_meets_its_square() -> None:
    def overlap_with_circle(ratio: float) -> float:
        angle = (np.arange(20_000) + 0.5) / 20_000 * np.pi / 2
        ellipse = 1 / (np.cos(angle) ** 2 / ratio + np.sin(angle) ** 2 * ratio)
        return float(np.minimum(ellipse, 1).sum() / np.maximum(ellipse, 1).sum())

    assert overlap_with_circle(ALIKE) == pytest.approx(math.pi / 4, abs=1e-4)


def test_a_viewer_sees_nearly_what_is_there(rng: np.random.Generator) -> None:
    parameters = random_superquadrics(400, rng)
    seen = perceived(parameters, rng)
    assert ((seen[:, :2] >= EXPONENTS[0]) & (seen[:, :2] <= EXPONENTS[1])).all()
    assert 0.01 < np.abs(np.log(seen[:, 2:] / parameters[:, 2:])).mean() < 0.08
    agreement = (names(seen) == names(parameters)).mean()
    assert 0.85 < agreement < 0.99
    np.testing.assert_array_equal(perceived(parameters, rng, 0.0), parameters)


def test_populations_stay_in_their_ranges(rng: np.random.Generator) -> None:
    uniform = thesis_superquadrics(500, rng)
    assert (uniform[:, 2:] >= SEMI_AXES[0]).all()
    for parameters in (uniform, random_superquadrics(500, rng)):
        assert ((parameters[:, :2] >= EXPONENTS[0]) & (parameters[:, :2] <= EXPONENTS[1])).all()
        assert (parameters[:, 2:] > 0).all()
        assert (parameters[:, 2:] <= SEMI_AXES[1]).all()
