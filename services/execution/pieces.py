"""Pieces of a triangle surface, how far each is from convex, and the cut that helps most."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from services.execution.convex import ConvexPart, convex_hull, hull_volume

Array = NDArray[np.float64]

SAMPLES = 400
"""Surface samples that a piece is judged by."""
CUTS = (0.25, 0.5, 0.75)
"""Where planes are tried, as shares of the extent along each principal axis."""


_DIGITS, _ON, _LEVEL = 7, 1e-9, 1e-3
"""Corners that agree to so many digits of a metre are one; a corner so near to a plane lies on it,
metres; planes whose normals span less than this meet nowhere."""


_LINE = Rotation.from_euler("xyz", [0.31, 0.57, 0.83]).as_matrix()
"""Its last column is the direction of the lines: one that no side of a model is likely to have."""


class Plane(NamedTuple):
    """All p with normal (3,) . p = offset."""

    normal: Array
    offset: float


class Division(NamedTuple):
    """A way to cut a piece: by one plane in two, or by two planes in four.

    Attributes
    ----------
    gain : float
        By how much the hulls shrink together for each piece that is added, cubic metres.
    planes : tuple of Plane
    """

    gain: float
    planes: tuple[Plane, ...]


@dataclass(frozen=True)
class Body:
    """What is cut: a closed surface's triangles (T, 3, 3), counter-clockwise from outside."""

    triangles: Array

    def holds(self, points: Array) -> NDArray[np.bool_]:
        """Say which points (K, 3) are inside.

        A line through the point leaves the body once more than it enters it, on either side.
        Where the surface is open it may do so on one side only; that is enough.
        """
        sides, depths = self._projected
        flat, depth = (points @ _LINE)[:, :2], (points @ _LINE)[:, 2]
        inside = np.zeros(len(points), dtype=np.bool_)
        for index, (x, y) in enumerate(flat):
            within = sides[:, :, 0] * x + sides[:, :, 1] * y + sides[:, :, 2]
            ahead, behind = (within > 0).all(axis=1), (within < 0).all(axis=1)
            met = np.flatnonzero(ahead | behind)
            if len(met):
                slope_x, slope_y, start = depths[met].T
                above = slope_x * x + slope_y * y + start > depth[index]
                # Up through a face that looks up, or down through one that looks down, is out.
                out = np.where(above == ahead[met], 1, -1)
                inside[index] = out.sum() != 0
        return inside

    @cached_property
    def _projected(self) -> tuple[Array, Array]:
        """Triangles along `_LINE`: each side as a line (T, 3, 3), and each plane's depth (T, 3).

        (x, y, 1) times a side is positive to its left; times a depth it is z.
        """
        corners = self.triangles @ _LINE
        start, end = corners[:, :, :2], np.roll(corners, -1, axis=1)[:, :, :2]
        along = end - start
        rise = start[:, :, 1] * along[:, :, 0] - start[:, :, 0] * along[:, :, 1]
        sides = np.stack([-along[:, :, 1], along[:, :, 0], -rise], axis=-1)
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        steep = np.abs(normals[:, 2]) < 1e-300
        scale = np.where(steep, np.inf, normals[:, 2])
        slopes = -normals[:, :2] / scale[:, None]
        level = corners[:, 0, 2] - (slopes * corners[:, 0, :2]).sum(axis=1)
        return sides, np.column_stack([slopes, level])


@dataclass(frozen=True)
class Piece:
    """What of a body lies on one side of each of some planes.

    Attributes
    ----------
    triangles : (T, 3, 3) array
        Its part of the body's surface, corners counter-clockwise from outside, metres. Where
        it was cut it is open.
    body : Body
    planes : tuple of Plane
        The cuts that bound it; it lies where normal . p >= offset.
    """

    triangles: Array
    body: Body
    planes: tuple[Plane, ...] = ()

    @classmethod
    def of(cls, triangles: Array) -> Piece:
        """Return a whole body of these triangles (T, 3, 3), in triangles that can be cut up."""
        longest = float(np.ptp(triangles, axis=(0, 1)).max()) / 20
        return cls(refined(triangles, longest), Body(triangles))

    @cached_property
    def inner_corners(self) -> Array:
        """Corners (K, 3) that three cuts made inside the body; its surface does not have them."""
        points = self._meetings(itertools.combinations(self.planes, 3))
        return points[self.body.holds(points)]

    @cached_property
    def hull(self) -> ConvexPart | None:
        if not len(self.triangles):
            return None
        return convex_hull(np.concatenate([self.triangles.reshape(-1, 3), self.inner_corners]))

    def _meetings(self, threes: Iterable[tuple[Plane, ...]]) -> Array:
        """Return the points (K, 3) in which three planes meet, within this piece's planes."""
        found = []
        for three in threes:
            normals = np.array([plane.normal for plane in three])
            if abs(np.linalg.det(normals)) > _LEVEL:
                found.append(np.linalg.solve(normals, [plane.offset for plane in three]))
        points = np.array(found).reshape(-1, 3)
        within = [points @ normal - offset >= -_ON for normal, offset in self.planes]
        return points[np.all(within, axis=0)] if within else points

    @cached_property
    def volume(self) -> float:
        """Of the hull, cubic metres."""
        return 0.0 if self.hull is None else self.hull.moments()[0]

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

    @cached_property
    def division(self) -> Division:
        """The cut that leaves the least between the surface and the hulls; a gain of 0: none.

        What counts is the volume of the hulls, for the body's own stays the same. How deep the
        surface lies below them does not tell: a thin slice of a bowl is a ring that is filled,
        though nothing of it is deep. No single plane empties a ring, nor the hull of a bowl;
        two that cross do.
        """
        if self.hull is None:
            return Division(0.0, ())
        vertices = self.hull.vertices
        _, axes = np.linalg.eigh(np.cov(vertices.T))
        low, high = (vertices @ axes).min(axis=0), (vertices @ axes).max(axis=0)

        def across(axis: int, share: float) -> Plane:
            return Plane(axes[:, axis], float(low[axis] + share * (high[axis] - low[axis])))

        middles = [across(axis, 0.5) for axis in range(3)]
        trials: list[tuple[Plane, ...]] = [(across(k, share),) for k in range(3) for share in CUTS]
        trials += itertools.combinations(middles, 2)
        outline = _Outline.of(self.triangles)
        best = Division(0.0, ())
        for planes, corners in zip(trials, self._new_corners(trials), strict=True):
            after = sum(outline.cell_volumes(planes, np.concatenate([self.inner_corners, corners])))
            gain = (self.volume - after) / (2 ** len(planes) - 1)
            if gain > best.gain:
                best = Division(gain, planes)
        return best

    def _new_corners(self, trials: Sequence[tuple[Plane, ...]]) -> list[Array]:
        """Return the inner corners (K, 3) that each of some divisions would make."""
        met = [
            self._meetings(
                three
                for three in itertools.combinations((*planes, *self.planes), 3)
                if any(three[0] is plane for plane in planes)
            )
            for planes in trials
        ]
        inside = self.body.holds(np.concatenate(met))
        ends = np.cumsum([len(points) for points in met])[:-1]
        return [points[kept] for points, kept in zip(met, np.split(inside, ends), strict=True)]

    def divided(self) -> list[Piece]:
        """Return the pieces of the best division."""
        pieces = [self]
        for plane in self.division.planes:
            pieces = [half for piece in pieces for half in piece._halves(plane)]
        return [piece for piece in pieces if piece.hull is not None]

    def _halves(self, plane: Plane) -> Iterator[Piece]:
        for side in (1, -1):
            own = Plane(side * plane.normal, side * plane.offset)
            yield Piece(clip(self.triangles, *own), self.body, (*self.planes, own))


@dataclass(frozen=True)
class _Outline:
    """Corners (N, 3) and edges (E, 2) of triangles (T, 3, 3), each once."""

    triangles: Array
    corners: Array
    edges: NDArray[np.intp]

    @classmethod
    def of(cls, triangles: Array) -> _Outline:
        corners, number = np.unique(
            np.round(triangles.reshape(-1, 3), _DIGITS), axis=0, return_inverse=True
        )
        number = number.reshape(-1, 3)
        edges = np.concatenate([number[:, [0, 1]], number[:, [1, 2]], number[:, [2, 0]]])
        return cls(triangles, corners, np.unique(np.sort(edges, axis=1), axis=0))

    def cell_volumes(self, planes: tuple[Plane, ...], more: Array) -> Iterator[float]:
        """Give the volume of the hull of each cell; infinite for a sheet that spans none.

        `more` (K, 3) are further points of the body.
        """
        cuts = [self._cut(plane) for plane in planes]
        if len(planes) == 2:
            cuts.append(self._pierced(*planes))
        points = np.concatenate([self.corners, *cuts, more])
        heights = [points @ normal - offset for normal, offset in planes]
        for sides in itertools.product((1, -1), repeat=len(planes)):
            inside = np.all(
                [side * height >= -_ON for side, height in zip(sides, heights, strict=True)], axis=0
            )
            volume = hull_volume(points[inside])
            yield volume if volume > 0 or not inside.any() else np.inf

    def _cut(self, plane: Plane) -> Array:
        """Return where edges cross a plane (C, 3)."""
        start, end = (self.corners[each] for each in self.edges.T)
        above, below = (each @ plane.normal - plane.offset for each in (start, end))
        crossing = above * below < 0
        share = above[crossing] / (above[crossing] - below[crossing])
        return np.asarray(start[crossing] + share[:, None] * (end[crossing] - start[crossing]))

    def _pierced(self, one: Plane, other: Plane) -> Array:
        """Return where the line in which two planes meet goes through the triangles (C, 3)."""
        along = np.cross(one.normal, other.normal)
        normals = np.array([one.normal, other.normal, along])
        start = np.linalg.solve(normals, [one.offset, other.offset, 0.0])
        corner, *ends = np.moveaxis(self.triangles, 1, 0)
        first, second = (end - corner for end in ends)
        turn = np.cross(along, second)
        scale = np.einsum("ij,ij->i", first, turn)
        met = np.abs(scale) > 1e-300
        corner, first, second, turn, scale = (
            each[met] for each in (corner, first, second, turn, scale)
        )
        across = np.cross(start - corner, first)
        u = np.einsum("ij,ij->i", start - corner, turn) / scale
        v = across @ along / scale
        inside = (u >= 0) & (v >= 0) & (u + v <= 1)
        away = np.einsum("ij,ij->i", second, across)[inside] / scale[inside]
        return np.asarray(start + away[:, None] * along)


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
