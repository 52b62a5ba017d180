from __future__ import annotations

import itertools

import numpy as np
import pytest

from services.primitive_recovery.classify import ShapeClassifier
from shared.schemas.primitive import ShapeClass
from tests.services.primitive_recovery.clouds import random_superquadric, superquadric


@pytest.fixture(scope="module")
def classifier() -> ShapeClassifier:
    return ShapeClassifier()


@pytest.mark.parametrize(
    ("expected", "exponents", "semi_axes"),
    [
        ("cuboid", (0.1, 0.1), (0.03, 0.05, 0.1)),
        ("cuboid", (0.2, 0.2), (0.05, 0.05, 0.05)),
        ("cuboid", (0.1, 2.0), (0.05, 0.05, 0.1)),  # a square column, turned by 45 degrees
        ("cuboid", (0.1, 0.1), (0.002, 0.05, 0.1)),
        ("cylinder", (0.1, 1.0), (0.03, 0.03, 0.1)),
        ("cylinder", (0.1, 1.0), (0.05, 0.05, 0.01)),
        ("cylinder", (1.0, 0.1), (0.1, 0.03, 0.03)),  # lies along its x
        ("cylinder", (1.0, 1.0), (0.02, 0.02, 0.1)),  # a cigar
        ("sphere", (1.0, 1.0), (0.05, 0.05, 0.05)),
        ("sphere", (0.9, 1.1), (0.05, 0.055, 0.05)),
    ],
)
def test_textbook_shapes(
    classifier: ShapeClassifier,
    expected: ShapeClass,
    exponents: tuple[float, float],
    semi_axes: tuple[float, float, float],
) -> None:
    ((found, probability),) = classifier.classify([superquadric(exponents, semi_axes)])
    assert found == expected
    assert 1 / 3 <= probability <= 1


def test_size_and_the_order_of_the_first_two_axes_do_not_matter(
    classifier: ShapeClassifier, rng: np.random.Generator
) -> None:
    for _ in range(50):
        body = random_superquadric(rng)
        a1, a2, a3 = body.semi_axes
        same = [
            superquadric(body.exponents, (a2, a1, a3)),
            superquadric(body.exponents, (8 * a1, 8 * a2, 8 * a3)),
            superquadric(body.exponents, (a1 / 64, a2 / 64, a3 / 64)),
        ]
        (name, probability), *others = classifier.classify([body, *same])
        for other, other_probability in others:
            assert other == name
            assert other_probability == pytest.approx(probability, abs=1e-5)


def test_the_axes_of_an_ellipsoid_do_not_matter(classifier: ShapeClassifier) -> None:
    for axes in [(0.05, 0.05, 0.055), (0.02, 0.03, 0.1)]:
        names = {
            classifier.classify([superquadric((1.0, 1.0), (a, b, c))])[0][0]
            for a, b, c in itertools.permutations(axes)
        }
        assert len(names) == 1


def test_many_at_once_or_none(classifier: ShapeClassifier, rng: np.random.Generator) -> None:
    bodies = [random_superquadric(rng) for _ in range(7)]
    together = classifier.classify(bodies)
    assert [name for name, _ in together] == [classifier.classify([b])[0][0] for b in bodies]
    assert classifier.classify([]) == []
