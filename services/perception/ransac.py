"""The planes of a view by RANSAC on a thinned cloud."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from services.perception.cloud import thin
from services.perception.observation import Observation
from services.perception.plane import MAP_VOXEL_M, MIN_SHARE, SAMPLE, Plane, measure_plane
from services.perception.settings import PerceptionSettings
from shared.geometry.plane import fit_plane, height_above

Array = NDArray[np.float64]

_NEIGHBOURS = 60
_SCREENED = 1000
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
        sample = points[np.sort(rng.integers(0, len(points), SAMPLE))]
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
    draws = settings.plane_hypotheses
    triples = rng.integers(0, len(points), size=(draws, 3))
    count = min(_NEIGHBOURS, len(points))
    local = triples[: draws // 2]
    _, neighbours = cKDTree(points).query(points[local[:, 0]], k=count)
    local[:, 1:] = np.take_along_axis(neighbours, local[:, 1:] % count, axis=1)
    corner = points[triples[:, 0]]
    normals = np.cross(points[triples[:, 1]] - corner, points[triples[:, 2]] - corner)
    lengths = np.linalg.norm(normals, axis=1)
    spread = lengths > 1e-7
    if not spread.any():
        return None
    normals = normals[spread] / lengths[spread, None]
    offsets = -np.einsum("ij,ij->i", normals, corner[spread])
    screen = points[rng.permutation(len(points))[:_SCREENED]]
    votes = _votes(screen, normals, offsets, settings.plane_tolerance_m)
    best: tuple[Array, float] | None = None
    most = -1.0
    for k in np.argsort(-votes, kind="stable")[:_FINALISTS]:
        normal, offset = normals[k], float(offsets[k])
        for _ in range(_REFITS):
            near = np.abs(height_above(points, normal, offset)) < settings.plane_tolerance_m
            if np.count_nonzero(near) < 3:
                break
            normal, offset = fit_plane(points[near])
        vote = _votes(points, normal[None], np.array([offset]), settings.plane_tolerance_m)[0]
        if vote > most:
            best, most = (normal, offset), vote
    return best


def _votes(points: Array, normals: Array, offsets: Array, tolerance: float) -> Array:
    """Return the score (H,) of hypotheses: near points, the nearer the more (MSAC)."""
    distance = (points @ normals.T + offsets) / tolerance
    return np.asarray(np.clip(1.0 - distance**2, 0.0, None).sum(axis=0))


def _towards(view: Observation, normal: Array, offset: float) -> tuple[Array, float]:
    """Turn a plane's normal to the sensor; for a sensor in the plane, to most of the points."""
    side = float(normal @ view.viewpoint + offset)
    if abs(side) < 0.02:
        heights = height_above(view.points, normal, offset)
        side = float(np.count_nonzero(heights > 0.02) - np.count_nonzero(heights < -0.02))
    return (normal, offset) if side >= 0 else (-normal, -offset)
