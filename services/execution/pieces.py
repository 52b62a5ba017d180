"""Pieces of a triangle surface, how far each is from convex, and the plane that helps most."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from services.execution.convex import ConvexPart, convex_hull

Array = NDArray[np.float64]

SAMPLES = 400
"""Surface samples that a piece is judged by."""
CORNERS = 1500
"""Corners that a trial cut is judged by."""
CUTS = (0.15, 0.3, 0.5, 0.7, 0.85)
"""Where planes are tried, as shares of the extent along each principal axis."""


@dataclass(frozen=True)
class Piece:
    """Some of a surface's triangles (T, 3, 3), corners counter-clockwise from outside, metres."""

    triangles: Array

    @cached_property
    def hull(self) -> ConvexPart | None:
        return convex_hull(self.triangles.reshape(-1, 3))

    @cached_property
    def area(self) -> float:
        return float(np.linalg.norm(self._turns, axis=1).sum() / 2)

    @cached_property
    def _turns(self) -> Array:
        corners = self.triangles
        return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])

    @cached_property
    def _samples(self) -> tuple[Array, Array]:
        """Centres and outward normals (S, 3) of triangles, drawn evenly by area."""
        lengths = np.linalg.norm(self._turns, axis=1)
        steps = np.cumsum(lengths)
        count = min(SAMPLES, 4 * len(steps))
        picked = np.searchsorted(steps, (np.arange(count) + 0.5) / count * steps[-1])
        return self.triangles[picked].mean(axis=1), self._turns[picked] / lengths[picked, None]

    @cached_property
    def depths(self) -> Array:
        """How far each surface sample lies below the hull, along its normal, metres (S,)."""
        if self.hull is None or self.area == 0:
            return np.zeros(1)
        return _depths(self.hull, *self._samples)

    @property
    def concavity(self) -> float:
        """What all but a twentieth of the surface stays within, metres."""
        return float(np.quantile(self.depths, 0.95))

    @property
    def void(self) -> float:
        """Roughly the volume between surface and hull, cubic metres."""
        return float(self.depths.mean()) * self.area

    def divided(self) -> list[Piece]:
        """Return the two pieces of the best of a few cuts across the principal axes."""
        if self.hull is None:
            return []
        corners = self.triangles.reshape(-1, 3)
        corners = corners[:: 1 + len(corners) // CORNERS]
        vertices = self.hull.vertices
        _, axes = np.linalg.eigh(np.cov(vertices.T))
        trials = [
            (axis, float(low + share * (high - low)))
            for axis in axes.T
            for low, high in [(np.min(vertices @ axis), np.max(vertices @ axis))]
            for share in CUTS
        ]
        _, best = min((self._void_after(corners, *cut), k) for k, cut in enumerate(trials))
        normal, offset = trials[best]
        halves = (Piece(clip(self.triangles, side * normal, side * offset)) for side in (1.0, -1.0))
        return [half for half in halves if half.hull is not None]

    def _void_after(self, corners: Array, normal: Array, offset: float) -> float:
        """Return the sum of the samples' depths in the halves of a trial cut."""
        centres, normals = self._samples
        total = 0.0
        for side in (1.0, -1.0):
            hull = convex_hull(corners[side * (corners @ normal - offset) >= 0])
            if hull is None:
                return np.inf
            here = side * (centres @ normal - offset) >= 0
            if here.any():
                total += float(_depths(hull, centres[here], normals[here]).sum())
        return total


def refined(triangles: Array, longest: float, most: int = 20_000) -> Array:
    """Return the same surface in triangles (U, 3, 3) with no edge over `longest` metres.

    Long triangles are quartered at the middles of their edges, as long as there
    are no more than `most`.
    """
    while len(triangles) <= most:
        edges = np.roll(triangles, -1, axis=1) - triangles
        long = np.linalg.norm(edges, axis=2).max(axis=1) > longest
        if not long.any():
            break
        a, b, c = np.moveaxis(triangles[long], 1, 0)
        ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
        quarters = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = np.concatenate(
            [triangles[~long], *(np.stack(corners, axis=1) for corners in quarters)]
        )
    return triangles


def clip(triangles: Array, normal: Array, offset: float) -> Array:
    """Return the triangles (U, 3, 3) that cover what lies at `normal . p >= offset`.

    A triangle that the plane crosses keeps its corner, or what is left without it.
    """
    above = triangles @ normal - offset
    inside = (above >= 0).sum(axis=1)
    kept = [triangles[inside == 3]]
    for corners_inside in (1, 2):
        crossed = inside == corners_inside
        corners, heights = _lone_corner_first(triangles[crossed], above[crossed], corners_inside)
        share = heights[:, :1] / (heights[:, :1] - heights[:, 1:])
        cut = corners[:, :1] + share[:, :, None] * (corners[:, 1:] - corners[:, :1])
        if corners_inside == 1:
            kept.append(np.stack([corners[:, 0], cut[:, 0], cut[:, 1]], axis=1))
        else:
            kept.append(np.stack([cut[:, 0], corners[:, 1], corners[:, 2]], axis=1))
            kept.append(np.stack([cut[:, 0], corners[:, 2], cut[:, 1]], axis=1))
    return np.concatenate(kept)


def _lone_corner_first(triangles: Array, above: Array, corners_inside: int) -> tuple[Array, Array]:
    """Turn each triangle until the corner that is alone on its side of the plane comes first."""
    lone = np.argmax((above >= 0) == (corners_inside == 1), axis=1)
    order = (lone[:, None] + np.arange(3)) % 3
    corners = np.take_along_axis(triangles, order[:, :, None], axis=1)
    return corners, np.take_along_axis(above, order, axis=1)


def _depths(hull: ConvexPart, points: Array, normals: Array) -> Array:
    """Return how far points (S, 3) can go along `normals` (S, 3) before they leave the hull."""
    outward, offsets = hull.planes
    gap = np.maximum(offsets - points @ outward.T, 0.0)
    speed = normals @ outward.T
    ahead = speed > 1e-6
    reach = np.divide(gap, speed, out=np.full_like(gap, np.inf), where=ahead)
    depth = np.asarray(reach.min(axis=1))
    return np.where(np.isfinite(depth), depth, 0.0)
