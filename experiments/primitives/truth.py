"""What the parts of a region really are: their size, and the name of their shape."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull
from scipy.stats import qmc

from experiments.catalogue import CatalogueObject
from experiments.framework.boxes import Box, smallest_box
from experiments.shapes.criterion import ALIKE
from shared.schemas.primitive import ShapeClass

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

CLEAR = 0.05
"""A name counts as known if its body overlaps the part by so much more than the next one's."""
POINTS = 2**11
_REACH = 1.3
"""Bodies may stick out of the part's box by this factor."""
_SCALES = np.linspace(0.6, _REACH, 15)


@dataclass(frozen=True)
class TruePart:
    """The parts of an object's region, taken as one body.

    Attributes
    ----------
    extents : (3,) array
        Edges of the smallest box in any orientation around them, ascending, metres.
    shape : str or None
        cuboid, cylinder or sphere; None where no name is clearly the best.
    """

    extents: Array
    shape: ShapeClass | None


def true_part(thing: CatalogueObject, task: str) -> TruePart:
    """Return what the region of a task is made of."""
    names = thing.regions[task]
    vertices = np.concatenate(
        [mesh.vertices for part in thing.parts if part.name in names for mesh in part.meshes]
    )
    box = smallest_box(vertices)
    return TruePart(box.lengths, _clear_name(overlaps(vertices, box)))


def overlaps(vertices: Array, box: Box) -> dict[ShapeClass, float]:
    """Return the best intersection over union of a part with a body of each name.

    The part is taken as its convex hull, so that a pot is no thin shell. The bodies
    stand in the middle of its smallest box, along its edges, in the scale of the
    best overlap: a box and an elliptic cylinder about each of the three axes, which
    stretch with the box, and a ball, which does not and is out of question if the
    box is longer than `ALIKE` times its width, as in the criterion for superquadrics.

    Parameters
    ----------
    vertices : (V, 3) array
        Of the part, metres.
    box : Box
        Around them.
    """
    sample = _REACH * (2 * qmc.Sobol(3, scramble=False).random(POINTS) - 1)
    points = sample + _REACH / POINTS  # the first one of the sequence lies on a corner
    hull = ConvexHull(box.local(vertices))
    inside = np.all(points @ hull.equations[:, :3].T + hull.equations[:, 3] <= 1e-9, axis=1)
    reach = np.abs(points)
    ball = 0.0
    if box.lengths[2] <= ALIKE * box.lengths[0]:
        middle = float(box.lengths.prod() ** (1 / 3))
        distance = np.linalg.norm(reach * box.lengths / middle, axis=1)
        ball = max(_iou(inside, distance <= scale) for scale in _SCALES)
    return {
        "cuboid": _stretched(inside, list(reach.T)),
        "cylinder": max(
            _stretched(inside, [np.hypot(*np.delete(reach, axis, axis=1).T), reach[:, axis]])
            for axis in range(3)
        ),
        "sphere": ball,
    }


def _stretched(inside: Mask, coordinates: list[Array]) -> float:
    """Return the best overlap with a body that is bounded in every coordinate by itself."""
    within = [[each <= scale for scale in _SCALES] for each in coordinates]
    return max(_iou(inside, np.logical_and.reduce(bounds)) for bounds in product(*within))


def _iou(one: Mask, other: Mask) -> float:
    return float((one & other).sum() / max(int((one | other).sum()), 1))


def _clear_name(overlap: dict[ShapeClass, float]) -> ShapeClass | None:
    (best, first), (_, second), _ = sorted(overlap.items(), key=lambda item: -item[1])
    return best if first - second >= CLEAR else None
