"""Pieces of one thing, separated only by the shadow that it throws on itself."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from services.perception.cloud import thin
from services.perception.observation import Observation
from services.perception.settings import PerceptionSettings
from services.perception.things import Thing, measure_thing
from shared.geometry.rotation import unit

Array = NDArray[np.float64]

_ALWAYS = 2.0
_MINOR = 0.1
_AROUND = 8
_STEPS = np.linspace(0.0, 1.0, 9)[1:-1, None]


def join_hidden(
    things: Sequence[Thing], view: Observation, gap: float, settings: PerceptionSettings
) -> list[Thing]:
    """Return the things, those joined that may be one thing behind its own shadow.

    A pan hides the root of its handle: two clusters, and the straight bridge between them
    lies in unseen space. Where the sensor looks through the bridge, the two are apart.
    An unseen bridge of up to twice the clustering `gap` joins; one of up to
    `hidden_gap_m` only a minor piece, so that a thing is not joined to the one in front.
    """
    pieces = [thing for thing in things if len(thing.members) >= settings.min_object_points]
    if len(pieces) < 2:
        return list(things)
    voxel = gap / 3
    corners = [_corners(view.points[piece.members]) for piece in pieces]
    clouds: dict[int, Array] = {}
    group = list(range(len(pieces)))
    for a, b in combinations(range(len(pieces)), 2):
        small, large = sorted((len(pieces[a].members), len(pieces[b].members)))
        reach = settings.hidden_gap_m if small < _MINOR * large else _ALWAYS * gap
        if group[a] == group[b] or _apart(corners[a], corners[b]) > reach:
            continue
        for piece in (a, b):
            if piece not in clouds:
                clouds[piece] = thin(view.points[pieces[piece].members], voxel)
        if _hidden_bridge(clouds[a], clouds[b], view, reach, voxel):
            group = [group[a] if label == group[b] else label for label in group]
    joined = [thing for thing in things if len(thing.members) < settings.min_object_points]
    for label in sorted(set(group)):
        own = [piece for piece, of in zip(pieces, group, strict=True) if of == label]
        if len(own) == 1:
            joined.append(own[0])
        else:
            members = np.sort(np.concatenate([piece.members for piece in own]))
            joined.append(measure_thing(view.points, members))
    return sorted(joined, key=lambda thing: -len(thing.members))


def _corners(points: Array) -> Array:
    return np.array([points.min(axis=0), points.max(axis=0)])


def _apart(a: Array, b: Array) -> float:
    """Return the distance between two boxes given by their corners (2, 3)."""
    return float(np.linalg.norm(np.maximum(np.maximum(a[0] - b[1], b[0] - a[1]), 0.0)))


def _hidden_bridge(a: Array, b: Array, view: Observation, reach: float, voxel: float) -> bool:
    """Tell whether a straight bridge of at most `reach` lies in unseen space all along.

    Unseen is what has a point of either cloud before it.
    """
    distances, nearest = cKDTree(a).query(b, distance_upper_bound=reach)
    ends = np.flatnonzero(np.isfinite(distances))
    if len(ends) == 0:
        return False
    starts = np.asarray(nearest, dtype=np.intp)[ends]
    start, end = a[starts][:, None] - view.viewpoint, b[ends][:, None] - view.viewpoint
    samples = start + _STEPS * (end - start)
    depths = np.linalg.norm(samples, axis=2)
    cloud = np.concatenate([a, b]) - view.viewpoint
    ranges = np.linalg.norm(cloud, axis=1)
    chord, which = cKDTree(unit(cloud)).query(unit(samples), k=min(_AROUND, len(cloud)))
    aside = chord * depths[..., None] < 1.5 * voxel
    before = ranges[np.asarray(which, dtype=np.intp)] < depths[..., None] + 2 * voxel
    unseen = (aside & before).any(axis=2)
    return bool(unseen.all(axis=1).any())
