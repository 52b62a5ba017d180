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

Array = NDArray[np.float64]

DIRECTIONS = 24
WIDEST = 1.2
"""Tangent of half the angle that an outline may fill; a sensor amid the points sees none."""

_PROBES = 48


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
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    ahead = middle - viewpoint
    distance = float(np.linalg.norm(ahead))
    if distance == 0:
        return _amid(points)
    hint = np.zeros(3)
    hint[np.argmin(np.abs(ahead))] = 1.0
    frame = frame_about(ahead / distance, hint)
    local = (points - viewpoint) @ frame
    if not bool((local[:, 2] > 0).all()):
        return _amid(points)
    flat = np.ascontiguousarray(local[:, :2] / local[:, 2:])
    if float(np.abs(flat).max()) > WIDEST:
        return _amid(points)
    centred = flat - flat.mean(axis=0)
    variances, axes = np.linalg.eigh(centred.T @ centred / len(flat))
    variances = np.maximum(variances, max(1e-6 * variances[1], 1e-18))
    spacing = nearest_spacing(flat, _PROBES)
    angle = np.arange(DIRECTIONS) * (2 * np.pi / DIRECTIONS)
    # Evenly around the outline when it is made as wide as long.
    outward = (np.column_stack([np.cos(angle), np.sin(angle)]) / np.sqrt(variances)) @ axes.T
    outward = np.ascontiguousarray(outward / np.sqrt((outward**2).sum(axis=1))[:, None])
    high, _, _ = extremes(flat, outward)
    normals = np.column_stack([outward, -(high + 0.5 * spacing)]) @ frame.T
    normals /= np.sqrt((normals**2).sum(axis=1))[:, None]
    across = centred @ axes
    width = float((across.max(axis=0) - across.min(axis=0)).min())
    width = max(width, spacing) * distance
    return Outline(normals, normals @ viewpoint, spacing * distance, width, frame)


def _amid(points: Array) -> Outline:
    size = np.sort(np.ptp(points, axis=0))
    spacing = float(size[2]) / max(np.sqrt(len(points)), 1.0)
    width = max(float(size[1]), 1e-2 * float(size[2]))
    return Outline(np.empty((0, 3)), np.empty(0), spacing, width, None)
