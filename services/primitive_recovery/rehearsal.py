"""Clouds that between them take every way through the kernels, for a warm start."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from shared.schemas.primitive import RecoverRequest
from shared.schemas.scene import SupportPlane

_POINTS = 600


def ems_rehearsal() -> RecoverRequest:
    """Return a request after which every kernel of the method `ems` has been compiled."""
    points = _ball_and_rod(np.random.default_rng(0))
    return RecoverRequest(points=points, method="ems", viewpoint=(1.0, 0.0, 0.0))


def rehearsal() -> Iterator[RecoverRequest]:
    """Return requests after which every kernel of the method `parts` has been compiled."""
    rng = np.random.default_rng(0)
    ball_and_rod = _ball_and_rod(rng)
    yield RecoverRequest(points=ball_and_rod, method="parts", viewpoint=(1.0, 0.0, 0.0))
    # Something in front of the rod.
    card = np.stack(np.meshgrid(0.2, np.arange(-5, 6), np.arange(20, 26)), axis=-1).reshape(-1, 3)
    yield RecoverRequest(
        points=ball_and_rod[np.abs(ball_and_rod[:, 2] - 0.14) > 0.01],
        method="parts",
        viewpoint=(1.0, 0.0, 0.0),
        obstacle_points=card * np.array([1.0, 0.005, 0.005]),
    )
    # The near side of a cone that stands on a table: a part with a taper.
    angle, height = rng.uniform(-1.4, 1.4, _POINTS), rng.uniform(0.0, 0.2, _POINTS)
    radius = 0.08 - 0.35 * height
    cone = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height])
    yield RecoverRequest(
        points=cone + rng.normal(scale=2e-4, size=cone.shape),
        method="parts",
        viewpoint=(1.0, 0.0, 0.4),
        plane=SupportPlane(normal=(0.0, 0.0, 1.0), offset=0.0, inliers=1000, residual_mm=0.2),
    )


def _ball_and_rod(rng: np.random.Generator) -> NDArray[np.float64]:
    directions = rng.normal(size=(_POINTS, 3))
    ball = 0.03 * directions / np.linalg.norm(directions, axis=1, keepdims=True)
    rod = rng.uniform(-1.0, 1.0, (_POINTS, 3)) * np.array([0.005, 0.005, 0.1])
    return np.vstack([ball, rod + np.array([0.0, 0.0, 0.13])])
