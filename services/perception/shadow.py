"""What a cloud hides from the sensor, and what may join two clouds unseen."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from shared.geometry.passes import about_mean
from shared.geometry.points import principal_axes_of_centred
from shared.geometry.rotation import unit

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_AROUND = 8
_STEPS = np.linspace(0.0, 1.0, 9)[1:-1, None]
_SLENDER = 2.5
_AIM = 8.0
_CUT = 0.95


def hidden(samples: Array, cloud: Array, viewpoint: Array, voxel: float) -> Mask:
    """Tell which samples (..., 3) have a point of `cloud` before them.

    Parameters
    ----------
    samples, cloud : (..., 3), (N, 3) arrays
        Metres; the cloud is thinned to `voxel`.
    viewpoint : (3,) array
        Position of the sensor.
    voxel : float
        A point hides what is within 1.5 of it of its ray, from 2 of it before the point.
    """
    rays = samples - viewpoint
    depths = np.linalg.norm(rays, axis=-1)[..., None]
    before = cloud - viewpoint
    ranges = np.linalg.norm(before, axis=1)
    chord, which = cKDTree(unit(before)).query(unit(rays), k=[*range(1, _AROUND + 1)])
    found = np.isfinite(chord)
    nearest = np.where(found, which, 0).astype(np.intp)
    hides = (chord * depths < 1.5 * voxel) & (ranges[nearest] < depths + 2 * voxel)
    return np.asarray((found & hides).any(axis=-1))


def hidden_bridge(a: Array, b: Array, viewpoint: Array, reach: float, voxel: float) -> bool:
    """Tell whether a straight bridge between two clouds lies in unseen space all along.

    Each point of `b` (M, 3) has one to the nearest of `a` (N, 3), up to `reach` long.
    """
    distances, nearest = cKDTree(a).query(b, distance_upper_bound=reach)
    ends = np.flatnonzero(np.isfinite(distances))
    if len(ends) == 0:
        return False
    start, end = a[np.asarray(nearest, dtype=np.intp)[ends]][:, None], b[ends][:, None]
    unseen = hidden(start + _STEPS * (end - start), np.concatenate([a, b]), viewpoint, voxel)
    return bool(unseen.all(axis=1).any())


def goes_on_behind(bar: Array, body: Array, viewpoint: Array, reach: float, voxel: float) -> bool:
    """Tell whether a slender cloud is cut off by the shadow of another, and aims at it.

    The bar's end towards the body is carried on along the bar's axis, as far as the body is
    from it and no further than `reach`. All the way, and over the bar's whole width, it
    must be the body that hides it, and the axis must pass close by the body. A bar that
    ends in sight has table to be seen beyond its end; one that lies behind by chance seldom
    aims at the body. Good continuation behind an occluder relates pieces in sight as in
    Kellman and Shipley (Cognitive Psychology, 1991).

    Parameters
    ----------
    bar, body : (N, 3), (M, 3) arrays
        Metres, thinned to `voxel`.
    viewpoint : (3,) array
        Position of the sensor.
    """
    middle, centred = about_mean(bar)
    _, axes = principal_axes_of_centred(centred)
    size = np.ptp(bar @ axes, axis=0)
    if size[0] < _SLENDER * max(float(size[1]), voxel):
        return False
    centre = body.mean(axis=0)
    ahead = axes[:, 0] * np.copysign(1.0, float((centre - middle) @ axes[:, 0]))
    along = centred @ ahead
    offsets = body - middle
    advance = offsets @ ahead
    aside = np.linalg.norm(offsets - advance[:, None] * ahead, axis=1)
    start = float(along.max())
    tip = bar[along > start - 1.5 * voxel]
    gap = float(np.min(cKDTree(tip).query(body)[0]))
    if gap > reach or not (aside[advance > start] < _AIM * voxel).any():
        return False
    steps = np.arange(voxel, max(gap, 4.5 * voxel), voxel)
    carried = tip[:, None] + steps[:, None] * ahead
    return bool(hidden(carried, body, viewpoint, voxel).mean() > _CUT)
