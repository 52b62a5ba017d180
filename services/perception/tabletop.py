"""One plane taken for the support: what lies on it and how sure that is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.perception.cloud import cluster
from services.perception.median import median
from services.perception.noise import SIGMA_PER_MEDIAN, measure_noise
from services.perception.observation import Observation
from services.perception.occlusion import join_hidden
from services.perception.pixels import distances, heights_above
from services.perception.plane import SAMPLE, Plane, refine
from services.perception.relief import relief
from services.perception.settings import PerceptionSettings
from services.perception.things import Thing, things_of

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_RIM_M = 0.02
_MIN_NEIGHBOURS = 3


@dataclass(frozen=True)
class Tabletop:
    """A view divided by a support plane.

    Attributes
    ----------
    plane : Plane or None
        None when the view has no support plane.
    residual : float
        Robust standard deviation of the plane's points about it, metres.
    inliers : int
        Points on the plane.
    on_plane, furniture : (M,) arrays of bool
        Points of the plane, and of other planes too long to belong to an object.
    things : list of Thing
        All clusters off the plane, the largest first.
    objects : list of Thing
        Those of them that stand on the plane and have the size of an object.
    """

    plane: Plane | None
    residual: float
    inliers: int
    on_plane: Mask
    furniture: Mask
    things: list[Thing]
    objects: list[Thing]


def lay_out(
    plane: Plane, others: Sequence[Plane], view: Observation, settings: PerceptionSettings
) -> Tabletop:
    """Return the view divided by `plane`, refined, given the `others` that were found."""
    points = view.points
    plane = refine(plane, points, settings)
    step = max(1, len(points) // SAMPLE)
    sample = points.take(np.arange(0, len(points), step), axis=0)
    heights = heights_above(sample, np.ascontiguousarray(plane.normal), plane.offset)
    near = np.abs(heights) < 2 * settings.plane_tolerance_m
    heights, ranges = heights[near], distances(sample, view.viewpoint)[near]
    noise = measure_noise(heights, ranges)
    standing, on_plane = relief(plane, points, view.viewpoint, noise, settings)
    furniture = _furniture(plane, others, points, standing, settings)
    members = np.flatnonzero(standing & ~furniture)
    spacing = float(np.sqrt(plane.area / max(1.0, plane.share * len(points))))
    things = _clusters(view, members, spacing, settings)
    objects = [
        thing
        for thing in things
        if thing.is_object(settings) and plane.carries(thing.centroid[None], _RIM_M)[0]
    ]
    residual = SIGMA_PER_MEDIAN * median(np.abs(heights))
    return Tabletop(
        plane, residual, int(np.count_nonzero(on_plane)), on_plane, furniture, things, objects
    )


def without_plane(view: Observation, spacing: float, settings: PerceptionSettings) -> Tabletop:
    """Return the view as things in the air."""
    nothing = np.zeros(len(view.points), dtype=bool)
    everything = np.arange(len(view.points))
    things = _clusters(view, everything, spacing, settings)
    objects = [thing for thing in things if thing.is_object(settings)]
    return Tabletop(None, 0.0, 0, nothing, nothing, things, objects)


def _clusters(
    view: Observation, members: NDArray[np.intp], spacing: float, settings: PerceptionSettings
) -> list[Thing]:
    gap = max(settings.cluster_gap_m, 3 * spacing)
    labels = cluster(view.points.take(members, axis=0), gap, _MIN_NEIGHBOURS)
    return join_hidden(things_of(view.points, members, labels), view, gap, settings)


def _furniture(
    plane: Plane,
    others: Sequence[Plane],
    points: Array,
    standing: Mask,
    settings: PerceptionSettings,
) -> Mask:
    """Tell which standing points belong to a plane too long for an object, such as a wall.

    It must be long in what stands: any object is in one plane with the table's edge.
    """
    furniture = np.zeros(len(points), dtype=bool)
    rows = np.flatnonzero(standing)
    for other in others:
        if other.length <= settings.max_object_extent_m or _same_surface(plane, other):
            continue
        near = rows[np.abs(other.heights(points.take(rows, axis=0))) < settings.plane_tolerance_m]
        near = near[other.carries(points.take(near, axis=0), _RIM_M)]
        reach = np.ptp(points.take(near, axis=0) @ other.basis, axis=0).max() if len(near) else 0.0
        furniture[near] |= reach > settings.max_object_extent_m
    return furniture


def _same_surface(plane: Plane, other: Plane) -> bool:
    """Tell a second layer of a warped or noisy surface from another surface."""
    middle = (other.basis @ other.box.mean(axis=0)) - other.normal * other.offset
    parallel = abs(float(plane.normal @ other.normal)) > np.cos(np.deg2rad(10.0))
    return bool(parallel and abs(float(plane.heights(middle))) < 0.03)
