"""Clusters of points as candidate objects."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from services.perception.observation import Observation
from services.perception.pixels import distances
from services.perception.settings import PerceptionSettings
from shared.geometry.passes import about_mean
from shared.geometry.points import principal_axes_of_centred

Array = NDArray[np.float64]

_CENTRAL_RAD = np.deg2rad(20.0)


@dataclass(frozen=True)
class Thing:
    """A cluster of points.

    Attributes
    ----------
    members : (K,) array
        Indices into the observation's points, increasing.
    points : (K, 3) array
        These points.
    centroid : (3,) array
        Mean point.
    extent : float
        Metres from end to end along the longest principal axis.
    """

    members: NDArray[np.intp]
    points: Array
    centroid: Array
    extent: float

    def is_object(self, settings: PerceptionSettings) -> bool:
        """Tell whether it is neither a speck nor furniture."""
        return (
            len(self.members) >= settings.min_object_points
            and settings.min_object_extent_m <= self.extent <= settings.max_object_extent_m
        )

    def off_gaze(self, view: Observation) -> float:
        """Return the angle (radians) between the sensor's gaze and the nearest member."""
        ranges = distances(self.points, view.viewpoint)
        cosines = ((self.points - view.viewpoint) @ view.gaze) / np.maximum(ranges, 1e-12)
        return float(np.arccos(np.clip(cosines.max(), -1.0, 1.0)))

    def distance(self, target: Array) -> float:
        """Return the distance (metres) of its nearest point to `target`."""
        return float(np.sqrt(((self.points - target) ** 2).sum(axis=1).min()))


def measure_thing(points: Array, members: NDArray[np.intp]) -> Thing:
    """Return the thing that consists of `points[members]`."""
    cloud = points.take(members, axis=0)
    centroid, centred = about_mean(cloud)
    _, axes = principal_axes_of_centred(centred)
    return Thing(members, cloud, centroid, float(np.ptp(cloud @ axes[:, 0])))


def things_of(points: Array, members: NDArray[np.intp], labels: NDArray[np.int32]) -> list[Thing]:
    """Return one thing per label >= 0, the one with the most points first.

    `labels` (K,) belong to `points[members]`; `members` (K,) increase.
    """
    order = np.argsort(labels, kind="stable")
    starts = np.searchsorted(labels[order], np.arange(labels.max(initial=-1) + 2))
    found = [measure_thing(points, members[order[start:stop]]) for start, stop in pairwise(starts)]
    return sorted(found, key=lambda thing: -len(thing.members))


def appeal(thing: Thing, view: Observation, target: Array | None) -> float:
    """Return how much a thing looks like the one that is meant, 0..1, one factor for all.

    Falls with the distance to `target`, or without one with the angle from the gaze.
    """
    if target is not None:
        return 1.0 / (1.0 + thing.distance(target) / 0.05)
    return float(1.0 / (1.0 + (thing.off_gaze(view) / _CENTRAL_RAD) ** 2))


def most_appealing(things: Sequence[Thing], view: Observation, target: Array | None) -> Thing:
    """Return the thing that is meant; of equals, the one with the most points."""
    if len(things) == 1:
        return things[0]
    return max(things, key=lambda thing: appeal(thing, view, target))
