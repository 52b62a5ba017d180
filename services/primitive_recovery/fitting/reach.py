"""How far a part reaches in the directions in which the camera can tell."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.fitting.extremes import extremes, rivals
from services.primitive_recovery.fitting.occlusion import hidden_ends
from services.primitive_recovery.fitting.outline import Outline, rim
from services.primitive_recovery.fitting.terms import AT_LEAST, EQUAL
from services.primitive_recovery.points import unit_rows
from shared.geometry.points import principal_axes

Array = NDArray[np.float64]

MODEL = 0.03
"""Tolerance of a plane that touches, as a share of the part's extent across it."""
AWAY = -0.2
"""Cosine to the sensor down to which a side counts as seen. A cylinder's side that faces
away so far is 2 % of the radius beyond its outline; a box's is not beyond it at all."""
THIN = 1e-2
"""Ratio of spreads beyond which directions are not drawn to a flat side any more."""

_CUBE = np.array([d for d in itertools.product((-1.0, 0.0, 1.0), repeat=3) if any(d)])


@dataclass(frozen=True)
class Reach:
    """Supports (K, 6), as `terms.support_terms` wants them, and the measures of the view.

    Attributes
    ----------
    shared : (K, 6) array
        Outline and near side.
    by_frame : (F, 6, 6) array
        Near side along the six half-axes of each frame; rows of no tolerance where unseen.
    hidden : (R,) bool array
        Where something in front hides the outline's end.
    outline : Outline
    """

    shared: Array
    by_frame: Array
    hidden: NDArray[np.bool_]
    outline: Outline

    def in_unit(self, centre: Array, scale: float) -> tuple[Array, Array]:
        """Return `shared` and `by_frame` about a centre (3,), in units of `scale` metres."""
        moved = []
        for rows in (self.shared.copy(), self.by_frame.copy()):
            rows[..., 3] = (rows[..., 3] - rows[..., :3] @ centre) / scale
            rows[..., 4] = np.maximum(rows[..., 4] / scale, 1e-3)
            moved.append(rows)
        return moved[0], moved[1]


def visible_reach(
    points: Array,
    viewpoint: Array,
    others: Array | None,
    noise: float,
    frames: Array,
) -> Reach:
    """Return how far points (n, 3) reach, as seen from `viewpoint` (3,).

    The outline is one half (`outline`). The other is the near side: where a convex body's
    outward normal faces the sensor its surface is seen, so there the farthest point is
    where the body ends. Noise, a standard deviation along the rays in metres, lifts the
    farthest of many points.

    Parameters
    ----------
    frames : (F, 3, 3) array
        Rotations whose columns are asked for as well, both ways.
    """
    edge = rim(points, viewpoint)
    variances, axes = principal_axes(points)
    spread = np.sqrt(np.maximum(variances, THIN**2 * variances[0]))
    cube = unit_rows((_CUBE / spread) @ axes.T)  # evenly over the cloud when it is made round
    columns = np.swapaxes(frames, 1, 2)
    half_axes = np.concatenate([columns, -columns], axis=1).reshape(-1, 3)
    normals = np.concatenate([edge.normals, cube, half_axes])
    normals = np.ascontiguousarray(normals)
    high, low, end = extremes(points, normals)
    to_sensor = viewpoint - points[end]
    distance = np.linalg.norm(to_sensor, axis=1)
    facing = np.einsum("kj,kj->k", normals, to_sensor) / np.maximum(distance, 1e-300)
    if edge.frame is None:
        facing[:] = 1.0
    lift = noise * np.abs(facing)
    many = np.ones(len(high))
    if noise > 0:
        many = np.maximum(rivals(points, normals, high - 2.0 * lift), 1.0)
    lateral = 0.5 * edge.spacing * np.sqrt(np.maximum(1.0 - facing**2, 0.0))
    tolerance = np.sqrt(lift**2 + lateral**2 + (MODEL * (high - low)) ** 2)
    farthest = high - lift * np.sqrt(2 * np.log(many))
    hidden = hidden_ends(points[end], viewpoint, edge, others)
    first = len(edge.normals)
    farthest[:first] = edge.reach
    tolerance[:first] = np.hypot(0.5 * edge.spacing, MODEL * (high - low)[:first])
    rows = np.column_stack([normals, farthest, tolerance, np.where(hidden, AT_LEAST, EQUAL)])
    seen = facing > AWAY
    rows[first:][~seen[first:], 4] = np.inf
    middle = first + len(cube)
    near = rows[first:middle]
    return Reach(
        np.concatenate([rows[:first], near[seen[first:middle]]]),
        rows[middle:].reshape(len(frames), 6, 6),
        hidden[:first],
        edge,
    )
