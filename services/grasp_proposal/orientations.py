"""Which way a hand may come: hypotheses about approach and closing direction.

Only the side that the sensor saw is known. So beside the search about the local
curvature axis (GPD), which looks for contacts on what is visible, there are
families for which the visible outline is enough: from above across the part, and
along the line of sight, where both edges that the pads touch are silhouettes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.surface import LocalFrames
from shared.geometry.rotation import unit
from shared.jit import kernel

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Vector = tuple[float, float, float]

_CURVATURE = (-70.0, -35.0, 0.0, 35.0, 70.0)
_ABOVE = (0.0, 30.0, -30.0, 60.0, -60.0, 90.0)
_SIGHT = (0.0, 45.0, -45.0, 90.0)
_SIDE = (0.0, 40.0, -40.0)
"""By how many degrees the hands of each family are turned."""
_STEEPEST_RISE = 0.3
_ALONG = 0.2
"""Less of a part than this across the approach: it runs along it."""
_LOOKS_DOWN = 0.05
"""Less of a line of sight than this is level: it looks straight down."""


@dataclass(frozen=True)
class Hands:
    """Hand orientations at surface points.

    Attributes
    ----------
    rotations : (S, K, 3, 3) array
        Columns x, y (closing), z (approach); K hypotheses at each of S points.
    possible : (S, K) bool array
        False for hands that would have to come from under the support plane.
    """

    rotations: Array
    possible: Mask


def hypothesise(
    frames: LocalFrames, up: Array | None, viewpoint: Array | None, turn_deg: float = 0.0
) -> Hands:
    """Return the hands to try at each point.

    Parameters
    ----------
    frames : LocalFrames
    up : (3,) array or None
        Against gravity; without it no family from above or from the side.
    viewpoint : (3,) array or None
        Position of the sensor; without it no family along the line of sight.
    turn_deg : float
        By which the hands of every family are turned further.
    """
    more, part = np.radians(turn_deg), np.ascontiguousarray(frames.part_axes)
    families = [
        _about_curvature_axis(frames.curvature_axes, frames.normals, *_turns(_CURVATURE, more))
    ]
    sight = None if viewpoint is None else unit(frames.points - viewpoint)
    if up is not None:
        families.append(_across(np.tile(-up, (len(part), 1)), part, *_turns(_ABOVE, more)))
    if sight is not None:
        families.append(_across(sight, part, *_turns(_SIGHT, more)))
    if sight is not None and up is not None:
        families.append(_across(unit(sight - up), part, *_turns(_SIGHT, more)))
        level = sight - (sight @ up)[:, None] * up
        families.append(_from_the_side(level, up, *_turns(_SIDE, more)))
    rotations = np.concatenate(families, axis=1)
    return Hands(rotations, _possible(rotations, np.zeros(3) if up is None else up))


def _turns(angles_deg: Sequence[float], more: float) -> tuple[Array, Array]:
    """Return cosines and sines."""
    turns = np.radians(angles_deg) + more
    return np.cos(turns), np.sin(turns)


@kernel
def _about_curvature_axis(axes: Array, normals: Array, cos: Array, sin: Array) -> Array:
    """Approach against the normal, turned about the axis that the hand straddles."""
    rotations = np.empty((len(axes), len(cos), 3, 3))
    for s in range(len(axes)):
        axis = _unit(axes[s, 0], axes[s, 1], axes[s, 2])
        inwards = (-normals[s, 0], -normals[s, 1], -normals[s, 2])
        sideways = _cross(axis, inwards)
        for k in range(len(cos)):
            _write(rotations[s, k], axis, _turned(inwards, sideways, cos[k], sin[k]))
    return rotations


@kernel
def _across(approach: Array, part: Array, cos: Array, sin: Array) -> Array:
    """Approach along `approach` (S, 3), closing across the part, turned by each of the angles."""
    rotations = np.empty((len(part), len(cos), 3, 3))
    for s in range(len(part)):
        z_axis = (approach[s, 0], approach[s, 1], approach[s, 2])
        x_axis = _flattened((part[s, 0], part[s, 1], part[s, 2]), z_axis)
        if np.sqrt(x_axis[0] ** 2 + x_axis[1] ** 2 + x_axis[2] ** 2) < _ALONG:
            least = np.argmin(np.abs(approach[s]))
            fallback = (1.0 * (least == 0), 1.0 * (least == 1), 1.0 * (least == 2))
            x_axis = _flattened(fallback, z_axis)
        x_axis = _unit(x_axis[0], x_axis[1], x_axis[2])
        y_axis = _cross(z_axis, x_axis)
        for k in range(len(cos)):
            _write(rotations[s, k], _turned(x_axis, y_axis, cos[k], sin[k]), z_axis)
    return rotations


@kernel
def _from_the_side(level: Array, up: Array, cos: Array, sin: Array) -> Array:
    """Approach along `level` (S, 3), closing level: an upright part; NaN where that is short."""
    rotations = np.empty((len(level), len(cos), 3, 3))
    x_axis = (up[0], up[1], up[2])
    for s in range(len(level)):
        x, y, z = level[s]
        length = np.sqrt(x**2 + y**2 + z**2)
        length = length if length > _LOOKS_DOWN else np.nan
        ahead = (x / length, y / length, z / length)
        aside = _cross(x_axis, ahead)
        for k in range(len(cos)):
            _write(rotations[s, k], x_axis, _turned(ahead, aside, cos[k], sin[k]))
    return rotations


@kernel
def _possible(rotations: Array, up: Array) -> Mask:
    """Say which rotations (S, K, 3, 3) are known and not from below; NaN in them becomes 0."""
    possible = np.ones(rotations.shape[:2], dtype=np.bool_)
    for s in range(rotations.shape[0]):
        for k in range(rotations.shape[1]):
            rotation = rotations[s, k]
            rise = rotation[0, 2] * up[0] + rotation[1, 2] * up[1] + rotation[2, 2] * up[2]
            possible[s, k] = rise <= _STEEPEST_RISE
            for i in range(3):
                for j in range(3):
                    if np.isnan(rotation[i, j]):
                        possible[s, k] = False
                        rotation[i, j] = 0.0
    return possible


@kernel
def _write(rotation: Array, x_axis: Vector, z_axis: Vector) -> None:
    """Write the rotation with these perpendicular unit axes."""
    y_axis = _cross(z_axis, x_axis)
    for i in range(3):
        rotation[i, 0], rotation[i, 1], rotation[i, 2] = x_axis[i], y_axis[i], z_axis[i]


@kernel
def _turned(one: Vector, other: Vector, cos: float, sin: float) -> Vector:
    """Return `one` turned towards `other`, which is perpendicular to it."""
    return (
        cos * one[0] + sin * other[0],
        cos * one[1] + sin * other[1],
        cos * one[2] + sin * other[2],
    )


@kernel
def _flattened(vector: Vector, normal: Vector) -> Vector:
    """Return `vector` without what it has along the unit vector `normal`."""
    along = vector[0] * normal[0] + vector[1] * normal[1] + vector[2] * normal[2]
    return (
        vector[0] - normal[0] * along,
        vector[1] - normal[1] * along,
        vector[2] - normal[2] * along,
    )


@kernel
def _cross(a: Vector, b: Vector) -> Vector:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


@kernel
def _unit(x: float, y: float, z: float) -> Vector:
    """Return a vector of length 1, or zero; see `shared.geometry.rotation.unit`."""
    largest = max(abs(x), abs(y), abs(z))
    if largest == 0.0:
        return (0.0, 0.0, 0.0)
    x, y, z = x / largest, y / largest, z / largest
    length = np.sqrt(x * x + y * y + z * z)
    return (x / length, y / length, z / length)
