"""Single superquadrics over the whole range of shapes, as for `ems` in test_recovery.py."""

from __future__ import annotations

import numpy as np
import pytest

from services.primitive_recovery.fitting import fit_part
from shared.schemas.scene import SupportPlane
from shared.superquadric import Superquadric
from tests.services.primitive_recovery.fitting.scenes import Array
from tests.services.primitive_recovery.singles import LARGE, MIDDLE, OVERLAP, SMALL, SURFACE, trials


def recover(points: Array, sensor: Array) -> Superquadric:
    # A plane far below tells the noise and nothing else.
    plane = SupportPlane(normal=(0.0, -1.0, 0.0), offset=10.0, inliers=1000, residual_mm=1.5)
    rng = np.random.default_rng(0)
    return fit_part(points, viewpoint=sensor, plane=plane, rng=rng).superquadric


@pytest.fixture(scope="module")
def found() -> dict[str, Array]:
    return trials(recover, ("noisy", "one view"), "fit_part", 60)


def test_all_shapes_from_all_sides(found: dict[str, Array]) -> None:
    rows = found["noisy"]
    assert np.median(rows[:, SURFACE]) < 3.2
    assert np.median(rows[:, OVERLAP]) > 0.87
    assert np.median(np.abs(rows[:, [SMALL, MIDDLE, LARGE]]), axis=0).max() < 8


def test_all_shapes_from_one_view(found: dict[str, Array]) -> None:
    rows = found["one view"]
    assert np.median(rows[:, SURFACE]) < 3.3
    assert np.median(rows[:, OVERLAP]) > 0.7  # `ems`: 0.45
    assert np.median(np.abs(rows[:, [SMALL, MIDDLE, LARGE]]), axis=0).max() < 20
