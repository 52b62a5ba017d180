from __future__ import annotations

import numpy as np
import pytest

from services.primitive_recovery.fitting.deformation import (
    deformation_of,
    deformed_distances,
    straightened,
)
from shared.schemas.primitive import Deformation
from tests.services.primitive_recovery.clouds import superquadric, surface_points
from tests.services.primitive_recovery.fitting.scenes import Array

AXES = np.array([0.012, 0.016, 0.09])
EXPONENTS = np.array([0.3, 0.9])


def deformed(points: Array, taper: tuple[float, float], bend: tuple[float, float]) -> Array:
    """Taper, then bend, as Solina and Bajcsy (1990, Eq. 9 to 24) write it."""
    level = points[:, 2] / AXES[2]
    x = points[:, 0] * (1 + taper[0] * level)
    y = points[:, 1] * (1 + taper[1] * level)
    z = points[:, 2]
    curvature, direction = bend
    if curvature == 0:
        return np.column_stack([x, y, z])
    across = np.cos(direction - np.arctan2(y, x)) * np.hypot(x, y)
    angle = z * curvature
    moved = 1 / curvature - np.cos(angle) * (1 / curvature - across)
    x = x + np.cos(direction) * (moved - across)
    y = y + np.sin(direction) * (moved - across)
    return np.column_stack([x, y, np.sin(angle) * (1 / curvature - across)])


def straight(rng: np.random.Generator) -> Array:
    e1, e2 = EXPONENTS
    return surface_points(superquadric((e1, e2), tuple(AXES.tolist())), 300, rng)


def found(points: Array, noise: float = 0.0002) -> Deformation | None:
    # As a fit leaves it: where the points lie off the straight body.
    values = np.concatenate([np.zeros(4), np.log(AXES), np.zeros(3)])
    off = deformed_distances(np.ascontiguousarray(points), EXPONENTS, values)
    return deformation_of(points, EXPONENTS, AXES, float(np.sqrt((off**2).mean())), noise)


@pytest.mark.parametrize("taper", [(0.0, 0.0), (0.4, -0.2)])
@pytest.mark.parametrize("bend", [(0.0, 0.0), (4.0, 0.7), (6.0, -2.0)])
def test_straightening_undoes_the_deformation(
    taper: tuple[float, float], bend: tuple[float, float], rng: np.random.Generator
) -> None:
    points = straight(rng)
    length = AXES[2]
    values = np.array(
        [*taper, length * bend[0] * np.cos(bend[1]), length * bend[0] * np.sin(bend[1]),
         *np.log(AXES), 0.0, 0.0, 0.0]
    )  # fmt: skip
    out = np.empty(3)
    for before, after in zip(points, deformed(points, taper, bend), strict=True):
        straightened(after, values, out)
        np.testing.assert_allclose(out, before, atol=1e-9)


def test_a_straight_part_has_none(rng: np.random.Generator) -> None:
    points = straight(rng)
    assert found(points + 0.0002 * rng.normal(size=points.shape)) is None
    rough = points + 0.002 * rng.normal(size=points.shape)
    assert found(rough, 0.0) is None  # large residual, but no shape in it


def test_a_taper_is_found(rng: np.random.Generator) -> None:
    points = deformed(straight(rng), (0.4, 0.3), (0.0, 0.0))
    result = found(points + 0.0002 * rng.normal(size=points.shape))
    assert result is not None
    np.testing.assert_allclose(result.taper, (0.4, 0.3), atol=0.08)
    assert result.bend[0] < 0.5


@pytest.mark.parametrize("direction", [0.0, 2.0, -1.2])
def test_a_bend_is_found(direction: float, rng: np.random.Generator) -> None:
    points = deformed(straight(rng), (0.0, 0.0), (3.0, direction))
    result = found(points + 0.0002 * rng.normal(size=points.shape))
    assert result is not None
    assert result.bend[0] == pytest.approx(3.0, rel=0.2)
    turn = (result.bend[1] - direction + np.pi) % (2 * np.pi) - np.pi
    assert abs(turn) < 0.15
    np.testing.assert_allclose(result.taper, (0.0, 0.0), atol=0.1)
