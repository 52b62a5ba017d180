"""One part: points in, superquadric out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.ems.kernels import radial_distances
from services.primitive_recovery.fitting.box import plain_box
from services.primitive_recovery.fitting.contact import support_contact
from services.primitive_recovery.fitting.covariance import covariance_of
from services.primitive_recovery.fitting.deformation import deformation_of
from services.primitive_recovery.fitting.descent import search
from services.primitive_recovery.fitting.fit import PartFit
from services.primitive_recovery.fitting.frames import candidate_frames
from services.primitive_recovery.fitting.reach import visible_reach
from services.primitive_recovery.fitting.starts import all_starts
from shared.geometry.rotation import quaternion_from_matrix
from shared.schemas.scene import SupportPlane
from shared.superquadric import Superquadric

Array = NDArray[np.float64]

LEAST_POINTS = 11
"""Fewer points get a plain box: a superquadric has as many unknowns."""
FIT_POINTS, COARSE_POINTS, FRAME_POINTS, REACH_POINTS = 200, 60, 200, 1000
"""How many points, drawn at random, the steps of a fit look at."""
MODEL = 0.015
"""How far a part's surface is off the best superquadric's, as a share of its width."""
FINALISTS = np.array([4, 4, 1, 12])
"""Starts that descend a little, steps they take; starts that go to the end, steps."""
LIMITS = np.array([[0.1, 0.1, *[np.log(1e-3)] * 3], [2.0, 2.0, *[np.log(3.0)] * 3]])
"""Of the exponents, and of the semi-axes' logarithms in the unit of the fit."""


def fit_part(
    points: Array,
    *,
    viewpoint: Array,
    plane: SupportPlane | None = None,
    up: Array | None = None,
    others: Array | None = None,
    rng: np.random.Generator,
) -> PartFit:
    """Return the superquadric of one part, completed where it was not seen.

    The points' distances say how the surface runs; the outline and the near side say how
    far the part reaches; the support plane, level frames and symmetry say what the sensor
    did not see, as far as the points leave it open (docs/decisions/0015-fitting.md).

    Parameters
    ----------
    points : (n, 3) array
        The part's visible points in metres, finite, n >= 1. Fewer than 11, or all at one
        place, get a box with a large covariance.
    viewpoint : (3,) array
        Where the sensor was; amid the points, they are taken for seen from all sides.
    plane : SupportPlane, optional
        What the object stands on; its residual is the noise of the points.
    up : (3,) array, optional
        Direction against gravity, where there is no plane.
    others : (m, 3) array, optional
        Visible points of the object's other parts and of its neighbours: where they hide
        the part, its end is not where its points end.
    rng : np.random.Generator
        Draws the points that a large part is fitted to.
    """
    viewpoint = np.asarray(viewpoint, dtype=np.float64)
    normal = _upward(plane, up)
    centre = points.mean(axis=0)
    scale = float(np.sqrt(((points - centre) ** 2).sum(axis=1).max()))
    if len(points) < LEAST_POINTS or scale <= 1e-9 * float(np.linalg.norm(centre - viewpoint)):
        return plain_box(points, viewpoint, normal)
    order = rng.permutation(len(points)) if len(points) > COARSE_POINTS else np.arange(len(points))
    some = np.ascontiguousarray(points[order[:REACH_POINTS]])
    noise = plane.residual_mm / 1e3 if plane is not None else 0.0
    frames = candidate_frames(some[:FRAME_POINTS], normal)
    reach = visible_reach(some, viewpoint, others, noise, frames)
    contact = None
    if plane is not None:
        contact = support_contact(some, plane, viewpoint, reach, centre, scale)
    cloud = np.ascontiguousarray((some[:FIT_POINTS] - centre) / scale)
    coarse = np.ascontiguousarray(cloud[:COARSE_POINTS])
    supports = reach.in_unit(centre, scale)
    starts = all_starts(coarse, frames, normal is not None, supports, contact)
    noise /= scale
    model = MODEL * max(reach.outline.width / scale, 0.01)
    _, shape, rotation, position, matrix = search(
        cloud, coarse, starts.supports, starts.priors, starts.rotations, starts.shapes,
        starts.positions, starts.odds, LIMITS, noise, model, len(points), FINALISTS,
    )  # fmt: skip
    if not bool(np.isfinite(shape).all() and np.isfinite(matrix).all()):
        return plain_box(points, viewpoint, normal)
    distances = radial_distances(
        cloud, np.concatenate([shape[:2], np.exp(shape[2:])]), rotation, position
    )
    residual = scale * float(np.sqrt((distances**2).mean()))
    signs = _towards(viewpoint - centre - scale * position, rotation)
    axes = scale * np.exp(shape[2:])
    own = scale * (cloud - position) @ (rotation * signs)
    quaternion = quaternion_from_matrix(rotation * signs)
    return PartFit(
        superquadric=Superquadric.from_vector(
            [*shape[:2], *axes, *(centre + scale * position), *quaternion]
        ),
        covariance=covariance_of(matrix, axes, scale, signs),
        residual=residual,
        deformation=deformation_of(own, shape[:2], axes, residual, scale * noise),
        rests=contact is not None and contact.touched_by(shape, rotation, position),
    )


def _upward(plane: SupportPlane | None, up: Array | None) -> Array | None:
    direction = plane.normal if plane is not None else up
    if direction is None:
        return None
    normal = np.array(direction, dtype=np.float64)
    return np.asarray(normal / np.linalg.norm(normal))


def _towards(to_sensor: Array, rotation: Array) -> Array:
    """Return signs (3,) that turn the x and z axes of a rotation (3, 3) to the sensor."""
    signs = np.where(to_sensor @ rotation < 0, -1.0, 1.0)
    signs[1] = signs[0] * signs[2]
    return signs
