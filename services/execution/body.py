"""The object as one rigid body of convex parts, described about its centre of mass."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.execution.convex import ConvexPart
from shared.geometry.se3 import inverse, pose_matrix

Array = NDArray[np.float64]

DENSITY = 400.0
"""kg/m^3: a half-full container, a wooden handle."""
MASS_RANGE = (0.05, 0.6)
"""kg: what a household object weighs, whatever its meshed volume says."""


@dataclass(frozen=True)
class RigidBody:
    """A rigid body whose frame sits at the centre of mass, along the principal axes.

    With that frame the simulator cannot misplace the centre of mass: PyBullet
    takes the origin of the collision shape for it.

    Attributes
    ----------
    parts : tuple of ConvexPart
        In the body's frame.
    world_from_body : (4, 4) array
    mass : float
        kg.
    inertia : (3,) array
        Principal moments, kg m^2.
    """

    parts: tuple[ConvexPart, ...]
    world_from_body: Array
    mass: float
    inertia: Array


def rigid_body(parts: Sequence[ConvexPart], mass: float | None = None) -> RigidBody:
    """Return the body that convex parts in the world's frame make up.

    Volume, centre of mass and inertia are sums over the parts: where parts
    overlap, the overlap counts twice. Without a `mass` (kg) it is guessed by the volume.
    """
    volumes, centroids, seconds = map(
        np.array, zip(*(part.moments() for part in parts), strict=True)
    )
    volume = float(volumes.sum())
    centre = volumes @ centroids / volume
    second = seconds.sum(axis=0) / volume - np.outer(centre, centre)
    spread, axes = np.linalg.eigh((second + second.T) / 2)
    if np.linalg.det(axes) < 0:
        axes[:, 2] *= -1
    if mass is None:
        mass = float(np.clip(DENSITY * volume, *MASS_RANGE))
    world_from_body = pose_matrix(centre, axes)
    return RigidBody(
        parts=tuple(part.moved(inverse(world_from_body)) for part in parts),
        world_from_body=world_from_body,
        mass=mass,
        inertia=mass * (spread.sum() - spread),
    )
