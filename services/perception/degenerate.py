"""Clouds without extent, told from thin and flat things."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.errors import DegenerateCloud
from shared.geometry.passes import about_mean
from shared.geometry.points import principal_axes_of_centred

Array = NDArray[np.float64]

_SPOT_M = 2e-4
_LINE = 1e-3
_PLANE = 1e-5


def require_area(points: Array) -> None:
    """Raise DegenerateCloud when points (N, 3) lie on a spot or a line."""
    _require(points, _deviations(points[:: max(1, len(points) // 5_000)]))


def require_volume(points: Array) -> None:
    """Raise DegenerateCloud when points (N, 3) lie on a spot, a line or an exact plane.

    One view of a flat face is flat too, but for the sensor's noise or the rounding of its
    depth; that is for the recovery of primitives to judge. Only what is flat to 1e-5 of
    its extent, to single precision in practice, is refused: no side of it is the inside.
    """
    deviations = _deviations(points)
    _require(points, deviations)
    if deviations[2] < _PLANE * deviations[0]:
        raise DegenerateCloud(
            f"all {len(points)} points lie exactly on a plane: there is no volume to recover",
            field="points",
            found=_millimetres(deviations),
            allowed=f"a thickness of at least {_PLANE:g} of the extent",
        )


def _deviations(points: Array) -> Array:
    centred = about_mean(np.ascontiguousarray(points))[1]
    return np.sqrt(principal_axes_of_centred(centred)[0])


def _require(points: Array, deviations: Array) -> None:
    if deviations[0] < _SPOT_M:
        shape = "one spot (were they divided by 1000 once too often?)"
    elif deviations[1] < _LINE * deviations[0]:
        shape = "a line"
    else:
        return
    raise DegenerateCloud(
        f"all {len(points)} points lie on {shape}: there is no surface to see",
        field="points",
        found=_millimetres(deviations),
        allowed="points spread in at least two directions",
    )


def _millimetres(deviations: Array) -> str:
    return "standard deviations " + ", ".join(f"{1e3 * d:.3g}" for d in deviations) + " mm"
