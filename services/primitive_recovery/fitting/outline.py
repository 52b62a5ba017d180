"""The outline of a part: planes through the sensor that the body touches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.fitting.extremes import (
    extremes,
    frame_about,
    nearest_spacing,
)
from services.primitive_recovery.points import over_depth, unit_rows
from shared.geometry.passes import about_mean, corners

Array = NDArray[np.float64]

DIRECTIONS = 24
WIDEST = 1.2
"""Tangent of half the angle that an outline may fill; a sensor amid the points sees none."""

_PROBES = 48
_ANGLES = np.arange(DIRECTIONS) * (2 * np.pi / DIRECTIONS)
_AROUND = np.column_stack([np.cos(_ANGLES), np.sin(_ANGLES)])


@dataclass(frozen=True)
class Outline:
    """The hull of a part's outline.

    Attributes
    ----------
    normals : (K, 3) array
        Outward unit normals of planes through the sensor; none where it is amid the points.
    reach : (K,) array
        How far along them the planes are, metres.
    spacing : float
        Distance of neighbouring points, metres.
    width : float
        The smaller width of the outline, metres.
    frame : (3, 3) array or None
        Rotation of the sensor that looks at the part; None where it is amid the points.
    """

    normals: Array
    reach: Array
    spacing: float
    width: float
    frame: Array | None


def rim(points: Array, viewpoint: Array) -> Outline:
    """Return the outline of points (n, 3) as seen from `viewpoint` (3,).

    Depth noise moves points along their rays and leaves the outline as it is. The centre
    of the outermost pixel is half a pixel inside of the true outline.
    """
    low, high = corners(points)
    ahead = (low + high) / 2 - viewpoint
    distance = float(np.linalg.norm(ahead))
    if distance == 0:
        return _amid(points)
    hint = np.zeros(3)
    hint[np.argmin(np.abs(ahead))] = 1.0
    frame = frame_about(ahead / distance, hint)
    flat, depth = over_depth((points - viewpoint) @ frame)
    if not depth.min() > 0 or float(np.abs(flat).max()) > WIDEST:
        return _amid(points)
    _, centred = about_mean(flat)
    variances, axes = np.linalg.eigh(centred.T @ centred / len(flat))
    variances = np.maximum(variances, max(1e-6 * variances[1], 1e-18))
    spacing = nearest_spacing(flat, _PROBES)
    # Evenly around the outline when it is made as wide as long.
    outward = unit_rows((_AROUND / np.sqrt(variances)) @ axes.T)
    farthest, _, _ = extremes(flat, outward)
    normals = unit_rows(np.column_stack([outward, -(farthest + 0.5 * spacing)]) @ frame.T)
    low, high = corners(centred @ axes)
    width = float((high - low).min())
    width = max(width, spacing) * distance
    return Outline(normals, normals @ viewpoint, spacing * distance, width, frame)


def _amid(points: Array) -> Outline:
    size = np.sort(np.ptp(points, axis=0))
    spacing = float(size[2]) / max(np.sqrt(len(points)), 1.0)
    width = max(float(size[1]), 1e-2 * float(size[2]))
    return Outline(np.empty((0, 3)), np.empty(0), spacing, width, None)
