"""Which way a hand may come: hypotheses about approach and closing direction.

Only the side that the sensor saw is known. So beside the search about the local
curvature axis (GPD), which looks for contacts on what is visible, there are
families for which the visible outline is enough: from above across the part, and
along the line of sight, where both edges that the pads touch are silhouettes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.surface import LocalFrames
from shared.geometry.rotation import unit

Array = NDArray[np.float64]

_CURVATURE_TURNS = np.radians([-70.0, -35.0, 0.0, 35.0, 70.0])
_ABOVE_TURNS = np.radians([0.0, 30.0, -30.0, 60.0, -60.0, 90.0])
_SIGHT_TURNS = np.radians([0.0, 45.0, -45.0, 90.0])
_SIDE_TURNS = np.radians([0.0, 40.0, -40.0])
_STEEPEST_RISE = 0.3


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
    possible: NDArray[np.bool_]


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
    part, more = frames.part_axes, np.radians(turn_deg)
    families = [_about_curvature_axis(frames, more)]
    sight = None if viewpoint is None else unit(frames.points - viewpoint)
    if up is not None:
        down = np.broadcast_to(-up, part.shape)
        families.append(_across(down, part, _ABOVE_TURNS + more))
    if sight is not None:
        families.append(_across(sight, part, _SIGHT_TURNS + more))
    if sight is not None and up is not None:
        slanted = unit(sight - up)
        families.append(_across(slanted, part, _SIGHT_TURNS + more))
        families.append(_from_the_side(sight, up, more))
    rotations = np.concatenate(families, axis=1)
    possible = np.asarray(np.isfinite(rotations).all(axis=(2, 3)))
    if up is not None:
        possible &= rotations[:, :, :, 2] @ up <= _STEEPEST_RISE
    return Hands(np.nan_to_num(rotations), possible)


def _about_curvature_axis(frames: LocalFrames, more: float) -> Array:
    """Approach against the normal, turned about the axis that the hand straddles."""
    axis = unit(frames.curvature_axes)
    inwards = -frames.normals
    sideways = np.cross(axis, inwards)
    cos, sin = np.cos(_CURVATURE_TURNS + more), np.sin(_CURVATURE_TURNS + more)
    approach = cos[None, :, None] * inwards[:, None] + sin[None, :, None] * sideways[:, None]
    x_axis = np.broadcast_to(axis[:, None], approach.shape)
    return _stack(x_axis, approach)


def _across(approach: Array, part: Array, turns: Array) -> Array:
    """Approach along `approach` (S, 3), closing across the part, turned by each of `turns`."""
    x_axis = part - approach * np.einsum("si,si->s", part, approach)[:, None]
    length = np.linalg.norm(x_axis, axis=1, keepdims=True)
    fallback = np.eye(3)[np.argmin(np.abs(approach), axis=1)]
    fallback = fallback - approach * np.einsum("si,si->s", fallback, approach)[:, None]
    x_axis = unit(np.where(length < 0.2, fallback, x_axis))
    y_axis = np.cross(approach, x_axis)
    cos, sin = np.cos(turns)[None, :, None], np.sin(turns)[None, :, None]
    turned = cos * x_axis[:, None] + sin * y_axis[:, None]
    return _stack(turned, np.broadcast_to(approach[:, None], turned.shape))


def _from_the_side(sight: Array, up: Array, more: float) -> Array:
    """Approach level, closing level: an upright part; NaN where one looks straight down."""
    level = sight - (sight @ up)[:, None] * up
    length = np.linalg.norm(level, axis=1, keepdims=True)
    level = np.divide(level, length, out=np.full_like(level, np.nan), where=length > 0.05)
    across = np.cross(up, level)
    turns = _SIDE_TURNS + more
    cos, sin = np.cos(turns)[None, :, None], np.sin(turns)[None, :, None]
    approach = cos * level[:, None] + sin * across[:, None]
    return _stack(np.broadcast_to(up, approach.shape), approach)


def _stack(x_axis: Array, z_axis: Array) -> Array:
    """Return rotations (S, K, 3, 3) from perpendicular unit axes (S, K, 3)."""
    return np.stack([x_axis, np.cross(z_axis, x_axis), z_axis], axis=3)
