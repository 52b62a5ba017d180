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
Rows = NDArray[np.intp]

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
        sample = points.take(rng.integers(borders[:-1], borders[1:]), axis=0)  # one of each stretch
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
        plane = measure_plane(
            *_towards(view, normal, offset), remaining.compress(near, axis=0), share
        )
        remaining, sample = remaining.compress(~near, axis=0), sample.compress(~voters, axis=0)
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
    some = points.take(rng.permutation(len(points))[:_SCREENED], axis=0)
    draws = settings.plane_hypotheses
    triples = rng.integers(0, len(some), size=(draws, 3))
    count = min(_NEIGHBOURS, len(some))
    local = triples[: draws // 2]
    _, neighbours = cKDTree(some).query(some.take(local[:, 0], axis=0), k=count)
    local[:, 1:] = np.take_along_axis(neighbours, local[:, 1:] % count, axis=1)
    corner, normals = corners_and_normals(some, triples)
    lengths = np.linalg.norm(normals, axis=1)
    spread = lengths > 1e-7
    if not spread.any():
        return None
    normals = normals.compress(spread, axis=0) / lengths[spread, None]
    offsets = -np.einsum("ij,ij->i", normals, corner.compress(spread, axis=0))
    tolerance = settings.plane_tolerance_m
    votes = count_votes(some, normals, offsets, tolerance)
    finalists = np.argsort(-votes, kind="stable")[:_FINALISTS]
    normals, offsets = _refit(points, normals[finalists], offsets[finalists], tolerance)
    best = int(np.argmax(count_votes(points, normals, offsets, tolerance)))
    return normals[best], float(offsets[best])


def _refit(points: Array, normals: Array, offsets: Array, tolerance: float) -> tuple[Array, Array]:
    """Return planes (F, 3), (F,) fitted to what lies within the tolerance, a few times over."""
    origin = points[0]
    offsets = offsets + np.vecdot(normals, origin)
    for _ in range(_REFITS):
        counts, means, scatters = moments_near(points, origin, normals, offsets, tolerance)
        enough = counts >= 3
        normals = np.where(enough[:, None], np.linalg.eigh(scatters)[1][:, :, 0], normals)
        offsets = np.where(enough, -np.vecdot(normals, means), offsets)
    return normals, offsets - np.vecdot(normals, origin)


@kernel
def corners_and_normals(points: Array, triples: Rows) -> tuple[Array, Array]:
    """Return a corner and the normal (H, 3) of triangles of points (N, 3), of any length."""
    corners, normals = np.empty(triples.shape), np.empty(triples.shape)
    for h in range(len(triples)):
        corner = points[triples[h, 0]]
        a, b = points[triples[h, 1]] - corner, points[triples[h, 2]] - corner
        corners[h] = corner
        normals[h, 0] = a[1] * b[2] - a[2] * b[1]
        normals[h, 1] = a[2] * b[0] - a[0] * b[2]
        normals[h, 2] = a[0] * b[1] - a[1] * b[0]
    return corners, normals


@kernel
def count_votes(points: Array, normals: Array, offsets: Array, tolerance: float) -> Array:
    """Return the score (H,) of planes: points (N, 3) near each, the nearer the more (MSAC)."""
    votes = np.zeros(len(normals))
    a, b, c = normals[:, 0].copy(), normals[:, 1].copy(), normals[:, 2].copy()
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        for h in range(len(normals)):  # within, since it is compiled to vector instructions
            away = (a[h] * x + b[h] * y + c[h] * z + offsets[h]) / tolerance
            votes[h] += max(1.0 - away * away, 0.0)
    return votes


def _towards(view: Observation, normal: Array, offset: float) -> tuple[Array, float]:
    """Turn a plane's normal to the sensor; for a sensor in the plane, to most of the points."""
    side = float(normal @ view.viewpoint + offset)
    if abs(side) < 0.02:
        heights = height_above(view.points, normal, offset)
        side = float(np.count_nonzero(heights > 0.02) - np.count_nonzero(heights < -0.02))
    return (normal, offset) if side >= 0 else (-normal, -offset)
