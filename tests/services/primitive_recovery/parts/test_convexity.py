"""Convex bodies that are seen from all sides are left whole."""

from __future__ import annotations

import numpy as np
import pytest

from services.primitive_recovery.parts.convexity import is_convex
from services.primitive_recovery.recovery import PrimitiveRecovery
from services.primitive_recovery.settings import PrimitiveRecoverySettings
from shared.schemas.primitive import RecoverRequest
from tests.services.primitive_recovery.clouds import superquadric, surface_points

RECOVERY = PrimitiveRecovery(PrimitiveRecoverySettings())


@pytest.mark.parametrize("exponents", [(0.1, 0.1), (0.1, 1.0), (1.0, 1.0)])
@pytest.mark.parametrize("seed", range(4))
def test_a_convex_body_from_all_sides_is_one_part(
    exponents: tuple[float, float], seed: int
) -> None:
    rng = np.random.default_rng(seed)
    points = surface_points(superquadric(exponents, (0.03, 0.04, 0.05)), 1000, rng)
    assert len(RECOVERY.recover(RecoverRequest(points=points)).primitives) == 1


def test_a_waist_is_not_convex(rng: np.random.Generator) -> None:
    ball = surface_points(superquadric((1.0, 1.0), (0.03, 0.03, 0.05)), 1000, rng)
    shift = np.array([0.0, 0.0, 0.045])
    assert not is_convex(np.vstack([ball - shift, ball + shift]), 0.003)


def test_a_flat_cloud_is_not_called_convex(rng: np.random.Generator) -> None:
    assert not is_convex(rng.uniform(size=(100, 3)) * [1, 1, 0], 0.05)
