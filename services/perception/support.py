"""Which of the planes in a view is the support: the one that carries what is looked at."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.perception.cloud import thin
from services.perception.observation import Observation
from services.perception.plane import MAP_VOXEL_M, Plane
from services.perception.ransac import find_planes
from services.perception.settings import PerceptionSettings
from services.perception.tabletop import Tabletop, lay_out, without_plane
from services.perception.things import Thing, appeal
from services.perception.up import guess_up
from shared.errors import NoObject

Array = NDArray[np.float64]

_CONTACT_M = 0.02
_BEHIND_M = 0.3
_BARE_WIDTH_M = 0.3
_BARE_SHARE = 0.9


def choose_support(
    view: Observation, target: Array | None, settings: PerceptionSettings, rng: np.random.Generator
) -> Tabletop:
    """Return the view divided by its support plane, with at least one object.

    A plane is a support only if something of the size of an object stands on it, on the
    sensor's side: so no bare wall, and no bare face of a box. Of several, the one that is
    seen most (share of the view and area, geometric mean), faces up as far as that can be
    guessed, and is touched by the thing that is looked at. Where no plane carries anything
    and none is wide, the view is that of things in the air, without a support plane.

    Raises
    ------
    NoObject
        A surface, but nothing of the size of an object on it.
    """
    planes = list(find_planes(view, settings, rng))
    planes.sort(key=lambda plane: _weight(plane, view), reverse=True)
    best: Tabletop | None = None
    bare: Tabletop | None = None
    most = 0.0
    for plane in planes:
        if _weight(plane, view) <= most:
            break
        others = [other for other in planes if other is not plane]
        top = lay_out(plane, others, view, settings)
        bare = bare or top
        carried = [appeal(thing, view, target) * _contact(top, thing) for thing in top.objects]
        worth = _weight(plane, view) * max(carried, default=0.0)
        if worth > most:
            best, most = top, worth
    if best is not None:
        return best
    if bare is not None and bare.plane is not None and _is_bare_surface(bare.plane):
        raise _nothing_on(bare, view, settings)
    air = without_plane(view, _spacing(view), settings)
    if not air.objects:
        raise _nothing_on(air, view, settings)
    return air


def _weight(plane: Plane, view: Observation) -> float:
    """Return how much of the view a plane is, and how level it may be."""
    level = max(0.0, float(plane.normal @ guess_up(view)))
    return float(np.sqrt(plane.share * plane.area)) * (0.1 + 0.9 * level**2)


def _contact(top: Tabletop, thing: Thing) -> float:
    """Return 1 for a thing that touches the plane, less the higher its lowest point is."""
    assert top.plane is not None
    gap = float(top.plane.heights(thing.points).min())
    return 1.0 / (1.0 + max(gap, 0.0) / _CONTACT_M)


def _is_bare_surface(plane: Plane) -> bool:
    """Tell an empty table from the largest face of a thing in the air."""
    return plane.width > _BARE_WIDTH_M or plane.share > _BARE_SHARE


def _spacing(view: Observation) -> float:
    """Return the typical distance between points, from the surface that they cover."""
    return float(MAP_VOXEL_M * np.sqrt(len(thin(view.points, MAP_VOXEL_M)) / len(view.points)))


def _nothing_on(top: Tabletop, view: Observation, settings: PerceptionSettings) -> NoObject:
    allowed = (
        f"at least {settings.min_object_points} points, "
        f"{1e3 * settings.min_object_extent_m:g} to {1e3 * settings.max_object_extent_m:g} mm long"
    )
    where = "in the view" if top.plane is None else "on the support plane"
    if top.things:
        largest = top.things[0]
        size = f"{len(largest.members)} points, {1e3 * largest.extent:.0f} mm long"
        found = f"the largest thing off it has {size}"
        if top.plane is not None:
            tallest = 1e3 * float(top.plane.heights(largest.points).max())
            found += f" and rises {tallest:.1f} mm"
    else:
        found = "nothing stands out of it" if top.plane is not None else "no points are close"
    message = f"no object {where}: {found}; an object has {allowed}"
    behind = 0
    if top.plane is not None:
        heights = top.plane.heights(view.points)
        beyond = (heights < -max(0.01, 6 * top.residual)) & (heights > -_BEHIND_M)
        behind = int(np.count_nonzero(top.plane.carries(view.points.compress(beyond, axis=0), 0.0)))
        off = len(view.points) - top.inliers
        if behind >= max(settings.min_object_points, off / 2):
            message += (
                f"; {behind} points lie behind it as seen from the viewpoint "
                f"{[round(float(c), 3) for c in view.viewpoint]}: is that where the sensor is?"
            )
    return NoObject(message, found=found, allowed=allowed, behind=behind)
