"""Pieces of one thing, separated only by the shadow that it throws on itself."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from services.perception.cloud import thin
from services.perception.observation import Observation
from services.perception.settings import PerceptionSettings
from services.perception.shadow import goes_on_behind, hidden_bridge
from services.perception.things import Thing, measure_thing
from shared.geometry.passes import corners

Array = NDArray[np.float64]

_ALWAYS = 2.0
_MINOR = 0.1


def join_hidden(
    things: Sequence[Thing], view: Observation, gap: float, settings: PerceptionSettings
) -> list[Thing]:
    """Return the things, those joined that may be one thing behind its own shadow.

    A pan hides the root of its handle: two clusters, and the straight bridge between them
    lies in unseen space. Where the sensor looks through the bridge, the two are apart.
    An unseen bridge of up to twice the clustering `gap` joins; one of up to
    `hidden_gap_m` only a minor piece, so that a thing is not joined to the one in front.
    A slender piece joins across up to `hidden_bar_m` where it is cut off by the shadow of
    the other and, carried on, meets it.
    """
    pieces = [thing for thing in things if len(thing.members) >= settings.min_object_points]
    if len(pieces) < 2:
        return list(things)
    voxel = gap / 3
    boxes = [corners(piece.points) for piece in pieces]
    clouds: dict[int, Array] = {}
    group = list(range(len(pieces)))
    for a, b in combinations(range(len(pieces)), 2):
        small, large = sorted((len(pieces[a].members), len(pieces[b].members)))
        reach = settings.hidden_gap_m if small < _MINOR * large else _ALWAYS * gap
        apart = _apart(boxes[a], boxes[b])
        if group[a] == group[b] or apart > max(reach, settings.hidden_bar_m):
            continue
        for piece in (a, b):
            if piece not in clouds:
                clouds[piece] = thin(pieces[piece].points, voxel)
        pair, seen_from = (clouds[a], clouds[b]), view.viewpoint
        if (apart <= reach and hidden_bridge(*pair, seen_from, reach, voxel)) or any(
            goes_on_behind(bar, body, seen_from, settings.hidden_bar_m, voxel)
            for bar, body in (pair, pair[::-1])
        ):
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


def _apart(a: tuple[Array, Array], b: tuple[Array, Array]) -> float:
    """Return the distance between two boxes given by their corners."""
    return float(np.linalg.norm(np.maximum(np.maximum(a[0] - b[1], b[0] - a[1]), 0.0)))
