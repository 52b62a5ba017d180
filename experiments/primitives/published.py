"""EMS in the form in which it was published: a reference for its time, not for its answers.

Liu, Wu, Ruan and Chirikjian: Robust and Accurate Superquadric Recovery (CVPR 2022), the
hierarchy about it and the removal of overlap (thesis, Algorithms 1 and 2), written from the text
in plain NumPy: SciPy's trust region method with finite differences over all points,
scikit-learn's DBSCAN over all outliers, and Algorithm 2 with the loops that it is printed with.
It is not the authors' code. The method `ems` is the same algorithm with compiled kernels,
analytic derivatives and a sample of the points (docs/decisions/0003-primitive-recovery.md).
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation
from sklearn.cluster import DBSCAN

from shared.schemas.primitive import PRESETS, EmsParameters

Array = NDArray[np.float64]

PUBLISHED = PRESETS["simulation"]
"""Table A.1."""
LARGEST = 10.0
"""Coordinate of the rescaled cloud."""
START_VARIANCE = 0.3
EVALUATIONS = 2
"""Of the optimiser in each M step."""
OUTLIER, ENOUGH, MOST, LAYERS = 0.1, 0.8, 4, 2
"""Probability of an inlier below which a point is none; share of inliers with which one
superquadric is enough; superquadrics and layers at most."""
SAMPLES, OVERLAP = 5000, 0.5
"""Of Algorithm 2: points of each volume for each pair, and the largest share that may overlap."""
_LEAST = 0.01


@dataclass(frozen=True)
class PublishedFit:
    """A superquadric (11,) as e1, e2, a1 to a3, Euler angles z y x, position; metres, radians.

    `inlier` (N,) is each point's probability to belong to it.
    """

    values: Array
    inlier: Array

    @cached_property
    def rotation(self) -> list[list[float]]:
        """Rows of the matrix from its own frame, as plain numbers."""
        rows: list[list[float]] = Rotation.from_euler("ZYX", self.values[5:8]).as_matrix().tolist()
        return rows


def published_parts(points: Array, parameters: EmsParameters = PUBLISHED) -> list[PublishedFit]:
    """Return the superquadrics of an object's points (N, 3), 1 to 4 of them: Algorithm 1."""
    found: list[PublishedFit] = []
    layer = [points]
    for _ in range(LAYERS):
        below: list[Array] = []
        for cloud in layer[: MOST - len(found)]:
            fit = published_fit(cloud, parameters)
            found.append(fit)
            if fit.inlier.sum() < ENOUGH * len(cloud):
                below += _clusters(cloud[fit.inlier < OUTLIER], parameters)
        layer = sorted(below, key=len, reverse=True)
    return found


def published_kept(parts: Sequence[PublishedFit]) -> list[PublishedFit]:
    """Return the superquadrics that Algorithm 2 leaves, as it is printed: a loop over points.

    What its text says of two that overlap both ways: the one with the smaller share stays.
    """
    rng = random.Random(0)
    share = np.zeros((len(parts), len(parts)))
    for i, one in enumerate(parts):
        for j, reference in enumerate(parts):
            if i == j:
                continue
            inside = 0
            for x, y, z in _samples(reference, rng):
                inside += _gauge(one, x, y, z) < 1
            share[j, i] = inside / SAMPLES
    return [
        part
        for j, part in enumerate(parts)
        if not any(
            share[j, i] > OVERLAP and (share[i, j] <= OVERLAP or share[j, i] > share[i, j])
            for i in range(len(parts))
        )
    ]


def _samples(part: PublishedFit, rng: random.Random) -> Iterator[tuple[float, float, float]]:
    """Give points of the volume, in the frame of the cloud, by rejection in the box around it."""
    a1, a2, a3 = part.values[2:5].tolist()
    r = part.rotation
    given = 0
    while given < SAMPLES:
        u, v, w = (a * rng.uniform(-1, 1) for a in (a1, a2, a3))
        x, y, z = (
            row[0] * u + row[1] * v + row[2] * w + middle
            for row, middle in zip(r, part.values[8:].tolist(), strict=True)
        )
        if _gauge(part, x, y, z) < 1:
            given += 1
            yield x, y, z


def _gauge(part: PublishedFit, x: float, y: float, z: float) -> float:
    """Return F of Eq. 3.2 at one point: below 1 inside."""
    e1, e2, a1, a2, a3, _, _, _, tx, ty, tz = part.values.tolist()
    r = part.rotation
    x, y, z = x - tx, y - ty, z - tz
    u = abs(r[0][0] * x + r[1][0] * y + r[2][0] * z) / a1
    v = abs(r[0][1] * x + r[1][1] * y + r[2][1] * z) / a2
    w = abs(r[0][2] * x + r[1][2] * y + r[2][2] * z) / a3
    if max(u, v, w) > 1:  # outside its box; the powers could overflow
        return 2.0
    value: float = (u ** (2 / e2) + v ** (2 / e2)) ** (e2 / e1) + w ** (2 / e1)
    return value


def published_fit(points: Array, parameters: EmsParameters = PUBLISHED) -> PublishedFit:
    """Return the superquadric of points (N, 3) by expectation, maximization and switch."""
    centre = points.mean(axis=0)
    unit = float(np.abs(points - centre).max()) / LARGEST
    cloud = (points - centre) / unit
    volume = float(np.prod(np.maximum(np.ptp(cloud, axis=0), _LEAST)))
    values, variance, cost, switches = _first_guess(cloud), START_VARIANCE, np.inf, 0
    inlier = np.ones(len(cloud))
    for iteration in range(parameters.max_iterations):
        inlier = _inliers(distances(cloud, values), variance, volume, parameters.outlier_ratio)
        values, new_cost = _maximized(cloud, inlier, values)
        settled = (cost - new_cost) / max(new_cost, 1e-12) < parameters.relative_tolerance
        cost = new_cost
        variance = max(cost / (3 * inlier.sum()), 1e-6)
        if cost < parameters.tolerance and iteration > 0:
            break
        if settled:
            if switches >= parameters.max_switches:
                break
            switches += 1
            for candidate in _similar(values):
                other, other_cost = _maximized(cloud, inlier, candidate)
                if other_cost < cost:
                    values, cost = other, other_cost
                    variance = max(cost / (3 * inlier.sum()), 1e-6)
                    break
    in_metres = values.copy()
    in_metres[2:5] *= unit
    in_metres[8:] = centre + unit * values[8:]
    return PublishedFit(in_metres, inlier)


def distances(points: Array, values: Array) -> Array:
    """Return the radial distances (N,) of points (N, 3) to a superquadric (11,)."""
    e1, e2, *a = values[:5]
    local = (points - values[8:]) @ Rotation.from_euler("ZYX", values[5:8]).as_matrix()
    x, y, z = np.abs(local.T) / np.array(a)[:, None] + 1e-12
    gauge = (x ** (2 / e2) + y ** (2 / e2)) ** (e2 / e1) + z ** (2 / e1)
    return np.asarray(np.linalg.norm(local, axis=1) * np.abs(1 - gauge ** (-e1 / 2)))


def _first_guess(cloud: Array) -> Array:
    axes = np.linalg.eigh(cloud.T @ cloud)[1][:, [2, 0, 1]]
    if np.linalg.det(axes) < 0:
        axes[:, 2] *= -1
    semi_axes = np.maximum(np.median(np.abs(cloud @ axes), axis=0), 2 * _LEAST)
    angles = Rotation.from_matrix(axes).as_euler("ZYX")
    return np.concatenate([[1.0, 1.0], semi_axes, angles, np.zeros(3)])


def _inliers(distance: Array, variance: float, volume: float, outlier_ratio: float) -> Array:
    clutter = (2 * np.pi * variance) ** 1.5 * outlier_ratio / (1 - outlier_ratio) / volume
    likelihood = np.exp(-(distance**2) / (2 * variance))
    return np.asarray(likelihood / (likelihood + clutter))


def _maximized(cloud: Array, inlier: Array, values: Array) -> tuple[Array, float]:
    reach = 4 * LARGEST
    lower = np.array([0.01, 0.01, *[_LEAST] * 3, *[-4 * np.pi] * 3, *[-reach] * 3])
    upper = np.array([2.0, 2.0, *[reach] * 3, *[4 * np.pi] * 3, *[reach] * 3])
    weight = np.sqrt(inlier)

    def weighted(trial: Array) -> Array:
        return np.asarray(weight * distances(cloud, trial))

    found = least_squares(
        weighted,
        np.clip(values, lower + 1e-6, upper - 1e-6),
        bounds=(lower, upper),
        max_nfev=EVALUATIONS,
    )
    return found.x, 2 * float(found.cost)


def _similar(values: Array) -> list[Array]:
    """Return the similar superquadrics: axes exchanged, and the dual of a square section."""
    rotation = Rotation.from_euler("ZYX", values[5:8])
    found = []
    for order in ((1, 2, 0), (2, 0, 1)):
        axes = list(order)
        turned = rotation * Rotation.from_matrix(np.eye(3)[:, axes])
        angles = turned.as_euler("ZYX")
        found.append(np.concatenate([values[[1, 0]], values[2:5][axes], angles, values[8:]]))
    e1, e2, a1, a2, a3 = values[:5]
    if 0.6 < a1 / a2 < 1.4:
        side = np.sqrt(a1 * a2) * 2 ** ((1 - e2) / 2)
        angles = (rotation * Rotation.from_euler("Z", np.pi / 4)).as_euler("ZYX")
        found.append(np.concatenate([[e1, 2 - e2, side, side, a3], angles, values[8:]]))
    return found


def _clusters(outliers: Array, parameters: EmsParameters) -> list[Array]:
    if len(outliers) < parameters.min_points:
        return []
    labels = DBSCAN(eps=parameters.eps, min_samples=parameters.min_points).fit_predict(outliers)
    clouds = [outliers[labels == label] for label in range(int(labels.max()) + 1)]
    return [cloud for cloud in clouds if len(cloud) >= parameters.min_points]
