"""How the parts of an object lie to each other: what Prolog is told beside their dimensions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.reasoning.bodies import Bodies
from services.reasoning.contact import touching
from services.reasoning.continuity import Continuity, continuities
from shared.schemas.primitive import Joint, Primitive
from shared.schemas.scene import SupportPlane

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Layout:
    """The object's frame and each of its P parts in it.

    Attributes
    ----------
    axes : (3, 3) array
        Columns are the object's axes in the frame of the parts, longest first.
    extents : (P, 3) array
        How long each part is along each axis, metres: the mean of its dimensions,
        geometric and weighted by the squared cosines between its own axes and the
        object's. Unlike the span of its bounding box this changes slowly when a
        long thin part is turned a little. The thickness counts as half the width
        at least, so that a sheet that leans does not shrink.
    intervals : (P, 2) array
        Where each part begins and ends along the first axis, metres from the
        object's end; here the span counts.
    slants : (P,) array
        Angle between the part's longest axis and the object's, 0 to 90 degrees.
    reaches : (P, P) array
        How far part i sticks out of part j, metres, in the direction from the
        centre of j to that of i.
    offsets : (P, P) array
        How far the centre of part i lies from that of j along the longest axis of
        j, relative to half of j's length: above 1 it lies past an end.
    heights : (P, 2) array or None
        Lowest and highest point of each part above the support plane, metres.
    meeting : tuple of (int, int)
        Which parts meet, the smaller index first.
    continuities : tuple of Continuity
        How far the two of each such pair look like pieces of one.
    """

    axes: Array
    extents: Array
    intervals: Array
    slants: Array
    reaches: Array
    offsets: Array
    heights: Array | None
    meeting: tuple[tuple[int, int], ...]
    continuities: tuple[Continuity, ...]


def layout_of(
    primitives: Sequence[Primitive], joints: Sequence[Joint], plane: SupportPlane | None
) -> Layout:
    """Return how the parts lie.

    Parameters
    ----------
    primitives : sequence of Primitive, at least one
        The parts.
    joints : sequence of Joint
        Which of them meet, where the recovery knows.
    plane : SupportPlane or None
        What the object stands on.
    """
    bodies = Bodies.of([primitive.superquadric for primitive in primitives])
    positions, rotations, dimensions = bodies.positions, bodies.rotations, bodies.full_extents
    axes = _main_axes(positions, rotations, dimensions)
    cosines = np.einsum("pij,ik->pjk", rotations, axes) ** 2
    thick = np.maximum(dimensions, np.sort(dimensions, axis=1)[:, 1:2] / 2)
    extents = np.exp(np.einsum("pjk,pj->pk", cosines, np.log(thick)))
    upright = [] if plane is None else [plane.normal]
    intervals, *heights = _spans(bodies, np.array([axes[:, 0], *upright]))
    longest = dimensions.argmax(axis=1)
    parts = np.arange(len(positions))
    along = cosines[parts, longest, 0]
    axis = rotations[parts, :, longest]
    apart = positions[:, None] - positions[None, :]
    offsets = 2 * np.abs(np.einsum("ijk,jk->ij", apart, axis)) / dimensions.max(axis=1)
    meeting = touching(primitives, joints)
    return Layout(
        axes=axes,
        extents=extents,
        intervals=intervals - intervals[:, 0].min(),
        slants=np.degrees(np.arccos(np.sqrt(np.clip(along, 0, 1)))),
        reaches=_reaches(bodies, apart),
        offsets=offsets,
        heights=None if plane is None else heights[0] + plane.offset,
        meeting=meeting,
        continuities=continuities(bodies, meeting),
    )


def _main_axes(positions: Array, rotations: Array, dimensions: Array) -> Array:
    """Return the principal axes (3, 3) of the parts, longest first.

    Each part counts by its length, so that a big pot does not outvote the
    handle that shows which way the pan lies.
    """
    weights = dimensions.max(axis=1) / dimensions.max(axis=1).sum()
    apart = positions - weights @ positions
    own = np.einsum("pij,pj,pkj->pik", rotations, dimensions**2 / 12, rotations)
    spread = np.einsum("p,pik->ik", weights, own + apart[:, :, None] * apart[:, None, :])
    return np.asarray(np.linalg.eigh(spread)[1][:, ::-1])


def _spans(bodies: Bodies, directions: Array) -> Array:
    """Return where each begins and ends along directions (K, 3): (K, P, 2) metres."""
    middle, half = bodies.positions @ directions.T, bodies.reach(directions)
    return np.stack([middle - half, middle + half], axis=-1).transpose(1, 0, 2)


def _reaches(bodies: Bodies, apart: Array) -> Array:
    """Return how far each sticks out of each other one (P, P); see `Layout`."""
    distance = np.linalg.norm(apart, axis=2)
    direction = apart / np.maximum(distance, 1e-12)[:, :, None]
    half = bodies.reach(direction)  # of i towards j, and by symmetry of i away from j
    return np.asarray(distance + half - half.T)
