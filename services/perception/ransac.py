"""The planes of a view by RANSAC on a thinned cloud."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from services.perception.cloud import thin
from services.perception.moments import moments_near
from services.perception.observation import Observation
from services.perception.plane import MAP_VOXEL_M, MIN_SHARE, SAMPLE, Plane, measure_plane
from services.perception.settings import PerceptionSettings
from shared.geometry.plane import height_above
from shared.jit import kernel

Array = NDArray[np.float64]

_NEIGHBOURS = 20
_SCREENED = 1500
_FINALISTS = 4
_REFITS = 3


def find_planes(
    view: Observation, settings: PerceptionSettings, rng: np.random.Generator
) -> Iterator[Plane]:
    """Yield the planes of a view, the one that explains most of its surface first.

    Each is found on the thinned cloud, where a square metre counts the same near and far,
    after the points of the former ones were taken away.
    """
    points = view.points
    sample = points
    if len(points) > SAMPLE:
        borders = np.linspace(0, len(points), SAMPLE + 1).astype(np.intp)
        sample = points[rng.integers(borders[:-1], borders[1:])]  # one of each stretch
    total = len(sample)
    remaining = thin(sample, MAP_VOXEL_M)
    for _ in range(settings.max_planes):
        if len(remaining) < 10 or len(sample) < MIN_SHARE * total:
            return
        found = _ransac(remaining, settings, rng)
        if found is None:
            return
        normal, offset = found
        near = np.abs(height_above(remaining, normal, offset)) < settings.plane_tolerance_m
        voters = np.abs(height_above(sample, normal, offset)) < settings.plane_tolerance_m
        share = np.count_nonzero(voters) / total
        plane = measure_plane(*_towards(view, normal, offset), remaining[near], share)
        remaining, sample = remaining[~near], sample[~voters]
        if plane is not None:
            yield plane


def _ransac(
    points: Array, settings: PerceptionSettings, rng: np.random.Generator
) -> tuple[Array, float] | None:
    """Return the plane with the most points (N, 3) within the tolerance, N >= 10.

    Half of the draws take three points anywhere, half take neighbours, which find small
    planes (Fischler and Bolles 1981; screening on a subset, Matas and Chum 2004). NumPy
    rather than Open3D's `segment_plane`, whose generator is one per process: requests
    that run at the same time would change each other's answers.
    """
    some = points[rng.permutation(len(points))[:_SCREENED]]
    draws = settings.plane_hypotheses
    triples = rng.integers(0, len(some), size=(draws, 3))
    count = min(_NEIGHBOURS, len(some))
    local = triples[: draws // 2]
    _, neighbours = cKDTree(some).query(some[local[:, 0]], k=count)
    local[:, 1:] = np.take_along_axis(neighbours, local[:, 1:] % count, axis=1)
    corner = some[triples[:, 0]]
    normals = np.cross(some[triples[:, 1]] - corner, some[triples[:, 2]] - corner)
    lengths = np.linalg.norm(normals, axis=1)
    spread = lengths > 1e-7
    if not spread.any():
        return None
    normals = normals[spread] / lengths[spread, None]
    offsets = -np.einsum("ij,ij->i", normals, corner[spread])
    tolerance = settings.plane_tolerance_m
    votes = count_votes(some, normals, offsets, tolerance)
    best: tuple[Array, float] | None = None
    most = -1.0
    for k in np.argsort(-votes, kind="stable")[:_FINALISTS]:
        normal, offset = _refit(points, normals[k], float(offsets[k]), tolerance)
        vote = count_votes(points, normal[None], np.array([offset]), tolerance)[0]
        if vote > most:
            best, most = (normal, offset), vote
    return best


def _refit(points: Array, normal: Array, offset: float, tolerance: float) -> tuple[Array, float]:
    """Return the plane fitted to what lies within the tolerance of it, a few times over."""
    origin = points[0]
    offset += float(normal @ origin)
    for _ in range(_REFITS):
        count, mean, scatter = moments_near(points, origin, normal, offset, tolerance)
        if count < 3:
            break
        normal = np.linalg.eigh(scatter)[1][:, 0].copy()
        offset = -float(normal @ mean)
    return normal, offset - float(normal @ origin)


@kernel
def count_votes(points: Array, normals: Array, offsets: Array, tolerance: float) -> Array:
    """Return the score (H,) of planes: points (N, 3) near each, the nearer the more (MSAC)."""
    votes = np.zeros(len(normals))
    for h in range(len(normals)):
        a, b, c, d = normals[h, 0], normals[h, 1], normals[h, 2], offsets[h]
        for i in range(len(points)):
            away = (a * points[i, 0] + b * points[i, 1] + c * points[i, 2] + d) / tolerance
            votes[h] += max(1.0 - away * away, 0.0)
    return votes


def _towards(view: Observation, normal: Array, offset: float) -> tuple[Array, float]:
    """Turn a plane's normal to the sensor; for a sensor in the plane, to most of the points."""
    side = float(normal @ view.viewpoint + offset)
    if abs(side) < 0.02:
        heights = height_above(view.points, normal, offset)
        side = float(np.count_nonzero(heights > 0.02) - np.count_nonzero(heights < -0.02))
    return (normal, offset) if side >= 0 else (-normal, -offset)
