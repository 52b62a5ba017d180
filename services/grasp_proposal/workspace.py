"""What a grasp is planned in: the request's points, thinned, in a frame of their own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.checks import checked_points, checked_superquadrics, checked_viewpoint
from services.grasp_proposal.hollows import hidden_floor
from services.grasp_proposal.surface import estimate_normals
from services.grasp_proposal.thinning import MAX_POINTS, thin
from shared.geometry.points import bounds, principal_axes
from shared.geometry.rotation import frame_from_z, unit
from shared.geometry.se3 import inverse, pose_matrix, transform_points
from shared.schemas.grasp import ProposeRequest
from shared.superquadric import Superquadric, surface_points, volume

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_FINE, _FINE_COUNT = (0.0015, 0.002, 0.0025, 0.003, 0.004), 3500
_COARSE, _COARSE_COUNT = (0.003, 0.004, 0.005, 0.006), 1200
_OBSTACLES = (0.004,)
_HAND_REACH = 0.5
_STEEP = 0.98
_MESH = (24, 48)
_GRAVITY, _DENSITY, _MASS = 9.81, 400.0, (0.05, 0.6)
_DIGITS = 9
"""Nanometres: the same numbers, to the last bit, wherever the scene was moved to."""


@dataclass(frozen=True)
class Workspace:
    """The object in its surroundings.

    The frame is tied to the scene: z is up (without a support plane or an up
    direction: towards the sensor), x points away from the sensor, the origin is
    the object's centroid. All that follows happens in it, so that a moved scene
    gives the same grasps, moved.

    Attributes
    ----------
    points, normals : (N, 3) arrays
        The object's surface, for exact checks; normals point outwards.
    in_focus : (N,) bool array
        Where grasps are wanted.
    coarse, coarse_normals : (M, 3) arrays
        The same surface with fewer points, for searching.
    floor : (F, 3) array
        Of hollows, where a wall hides it (`hidden_floor`).
    obstacles : (K, 3) array
    up : (3,) array or None
    support_offset : float or None
        A point is `up . p + support_offset` above the support plane.
    viewpoint : (3,) array or None
        None when it lies among the points, so that nothing follows from it.
    centre_of_mass : (3,) array
        Of the superquadrics, each as heavy as it is large, or else the mean of the evenly
        thinned surface.
    weight : float
        Newtons, guessed.
    bodies : tuple of Superquadric
        What was recovered from the object, in the request's frame.
    outer_from_work : (4, 4) array
        Motion into the request's frame.
    """

    points: Array
    normals: Array
    in_focus: Mask
    coarse: Array
    coarse_normals: Array
    floor: Array
    obstacles: Array
    up: Array | None
    support_offset: float | None
    viewpoint: Array | None
    centre_of_mass: Array
    weight: float
    bodies: tuple[Superquadric, ...]
    outer_from_work: Array

    @property
    def solid(self) -> Array:
        """Points (S, 3) that no finger may be in: what was seen, and floors that a wall hides."""
        return np.vstack([self.points, self.floor])

    @property
    def believed(self) -> Array:
        """Points (B, 3) on the surfaces of the bodies, seen or not."""
        surfaces = [surface_points(body, *_MESH) for body in self.bodies]
        points = np.vstack([np.empty((0, 3)), *surfaces])
        return np.asarray(transform_points(inverse(self.outer_from_work), points).round(_DIGITS))

    def heights(self, points: Array) -> Array:
        """Return heights (...,) of points (..., 3) above the support plane, inf without one."""
        if self.up is None or self.support_offset is None:
            return np.full(points.shape[:-1], np.inf)
        return np.asarray(points @ self.up + self.support_offset)


def build_workspace(request: ProposeRequest) -> Workspace:
    """Check a request and return its workspace.

    Raises
    ------
    EmptyCloud, InvalidInput
        See `checked_points`, `checked_superquadrics` and `checked_viewpoint`.
    """
    points, focus = checked_points(request)
    bodies = checked_superquadrics(request, points)
    order = np.lexsort((focus, *points.T))
    points, focus = points[order], focus[order]
    up, offset = _up_and_offset(request)
    viewpoint = _usable_viewpoint(checked_viewpoint(request), points)
    outer_from_work = _scene_frame(points, up, viewpoint)
    work_from_outer = inverse(outer_from_work)
    if up is not None:
        if offset is not None:
            offset = round(offset + float(up @ outer_from_work[:3, 3]), _DIGITS)
        up = (work_from_outer[:3, :3] @ up).round(_DIGITS)
    points = transform_points(work_from_outer, points).round(_DIGITS)
    order = _by_height(points, focus)
    points, focus = points[order], focus[order]
    fine = thin(points, _FINE, _FINE_COUNT)
    kept, kept_focus = points[fine], focus[fine]
    if not kept_focus.any():  # the focus is smaller than a voxel
        kept = np.vstack([kept, points[focus][:1]])
        kept_focus = np.append(kept_focus, True)
    seen_from = None
    if viewpoint is not None:
        seen_from = transform_points(work_from_outer, viewpoint[None])[0].round(_DIGITS)
    coarse = thin(kept, _COARSE, _COARSE_COUNT)
    normals = estimate_normals(kept, kept[coarse], seen_from)
    return Workspace(
        points=kept,
        normals=normals,
        in_focus=kept_focus,
        coarse=kept[coarse],
        coarse_normals=normals[coarse],
        floor=hidden_floor(kept[coarse], normals[coarse], up, seen_from).round(_DIGITS),
        obstacles=_near_obstacles(request, work_from_outer, points),
        up=up,
        support_offset=offset,
        viewpoint=seen_from,
        centre_of_mass=_centre_of_mass(bodies, work_from_outer, kept[coarse]),
        weight=_weight(bodies, kept[coarse]),
        bodies=bodies,
        outer_from_work=outer_from_work,
    )


def _by_height(points: Array, focus: Mask) -> NDArray[np.intp]:
    """Return the order of points (N, 3) by z, then y, x and focus: `lexsort` of the few equal z."""
    order = np.argsort(points[:, 2])
    heights = points[order, 2]
    equal = heights[1:] == heights[:-1]
    tied = np.append(equal, False) | np.append(False, equal)
    rows = order[tied]
    order[tied] = rows[np.lexsort((focus[rows], *points[rows].T))]
    return order


def _centre_of_mass(
    bodies: Sequence[Superquadric], work_from_outer: Array, surface: Array
) -> Array:
    """Return the mean of the bodies' centres by volume (3,), which count what was not seen, too.

    The mean of the visible surface lies nearer to the sensor than the centre of mass.
    """
    if not bodies:
        return np.asarray(surface.mean(axis=0))
    volumes = np.array([volume(body) for body in bodies])
    centre = volumes @ np.array([body.position for body in bodies]) / volumes.sum()
    return np.asarray(transform_points(work_from_outer, centre[None])[0].round(_DIGITS))


def _weight(bodies: Sequence[Superquadric], surface: Array) -> float:
    """Guess the weight in newtons: 400 kg/m3, 50 g to 600 g; half the bounding box is full."""
    if bodies:
        filled = sum(volume(body) for body in bodies)
    else:
        _, axes = principal_axes(surface)
        filled = 0.5 * float(np.prod(np.ptp(surface @ axes, axis=0)))
    return _GRAVITY * float(np.clip(_DENSITY * filled, *_MASS))


def _near_obstacles(request: ProposeRequest, work_from_outer: Array, points: Array) -> Array:
    """Return the obstacles (K, 3) that a hand at the object (N, 3) could meet."""
    if request.obstacle_points is None or not len(request.obstacle_points):
        return np.empty((0, 3))
    obstacles = transform_points(work_from_outer, request.obstacle_points).round(_DIGITS)
    low, extents = bounds(points)
    low, high = low - _HAND_REACH, low + extents + _HAND_REACH
    obstacles = obstacles[((obstacles >= low) & (obstacles <= high)).all(axis=1)]
    obstacles = obstacles[np.lexsort(obstacles.T)]
    return np.asarray(obstacles[thin(obstacles, _OBSTACLES, MAX_POINTS)])


def _up_and_offset(request: ProposeRequest) -> tuple[Array | None, float | None]:
    """Return the unit up direction and the support plane's offset, where they are known."""
    if request.plane is not None:
        length = float(np.linalg.norm(request.plane.normal))
        return unit(request.plane.normal), request.plane.offset / length
    return (None if request.up is None else unit(request.up)), None


def _usable_viewpoint(viewpoint: Array, points: Array) -> Array | None:
    """Return the viewpoint unless it lies among the points or next to them."""
    columns = np.ascontiguousarray(points.T) - viewpoint[:, None]
    rays = columns / np.maximum(np.linalg.norm(columns, axis=0), 1e-12)
    mean = rays.mean(axis=1)
    if np.linalg.norm(mean) < 0.5 or (unit(mean) @ rays).min() < 0.3:
        return None
    return viewpoint


def _scene_frame(points: Array, up: Array | None, viewpoint: Array | None) -> Array:
    centre = points.mean(axis=0)
    if up is not None and viewpoint is not None:
        hint = unit(centre - viewpoint)
        if abs(hint @ up) < _STEEP:
            return pose_matrix(centre, frame_from_z(up, hint))
    _, axes = principal_axes(points)
    long_axis = _signed(axes[:, 0], points)
    if up is not None:
        z_axis = up
    elif viewpoint is not None:
        z_axis = -unit(centre - viewpoint)
    else:
        z_axis = _signed(axes[:, 2], points)
    return pose_matrix(centre, frame_from_z(z_axis, long_axis))


def _signed(axis: Array, points: Array) -> Array:
    """Return the axis with the sign that makes the points' skewness along it positive."""
    along = (points - points.mean(axis=0)) @ axis
    return axis if (along**3).sum() >= 0 else -axis
