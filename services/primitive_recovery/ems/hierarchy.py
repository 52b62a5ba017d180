"""Hierarchical decomposition: Algorithm 1 of the thesis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.ems.clusters import dense_clusters
from services.primitive_recovery.ems.expectation import OUTLIER_PROBABILITY
from services.primitive_recovery.ems.recovery import Fit, recover_one
from services.primitive_recovery.validation import flatness
from shared.schemas.primitive import EmsParameters
from shared.superquadric import Superquadric

Array = NDArray[np.float64]

MAX_SUPERQUADRICS = 4
MAX_LAYERS = 2
ENOUGH_INLIERS = 0.8
"""Share of the points, by probability, that one superquadric must explain to be the only one."""


@dataclass(frozen=True)
class Part:
    """A superquadric and the points that it was fitted to.

    Attributes
    ----------
    superquadric : Superquadric
    support : int
        How many points these are: the inliers of its fit.
    residual : float
        Root mean square of their radial distances, in metres.
    """

    superquadric: Superquadric
    support: int
    residual: float


def decompose(
    points: Array,
    parameters: EmsParameters,
    viewpoint: Array,
    fit_points: int,
    rng: np.random.Generator,
) -> list[Part]:
    """Return the parts (1 to 4) of points (N, 3), largest support first.

    A superquadric is fitted to the points; where it explains too few of them, its
    outliers are clustered and each cluster is fitted in turn, largest first. See
    `recover_one` for the parameters.
    """
    parts: list[Part] = []
    layer = [points]
    for depth in range(MAX_LAYERS):
        below: list[Array] = []
        for cloud in layer:
            if len(parts) == MAX_SUPERQUADRICS:
                break
            fit = recover_one(cloud, parameters, viewpoint, fit_points, rng)
            parts.append(_part(fit))
            if depth + 1 < MAX_LAYERS:
                below += _left_over(cloud, fit, parameters)
        layer = sorted(below, key=len, reverse=True)
    return sorted(parts, key=lambda part: part.support, reverse=True)


def _part(fit: Fit) -> Part:
    inlier = fit.probability >= OUTLIER_PROBABILITY
    distances = fit.distances[inlier] if inlier.any() else fit.distances
    return Part(fit.superquadric, int(inlier.sum()), float(np.sqrt((distances**2).mean())))


def _left_over(cloud: Array, fit: Fit, parameters: EmsParameters) -> list[Array]:
    if fit.probability.sum() >= ENOUGH_INLIERS * len(cloud):
        return []
    outliers = np.ascontiguousarray(cloud[fit.probability < OUTLIER_PROBABILITY])
    local = fit.superquadric.to_local(outliers)
    found = dense_clusters(local, parameters.eps, parameters.min_points)
    clouds = [np.ascontiguousarray(outliers[indices]) for indices in found]
    return [one for one in clouds if flatness(one) is None]
