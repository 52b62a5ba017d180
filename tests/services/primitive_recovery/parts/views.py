"""Objects of the catalogue as a camera sees them, for tests of the cuts."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from experiments.camera import StereoNoise
from experiments.catalogue import variant
from experiments.dataset.drop import body_of
from experiments.dataset.make import make_view
from shared.schemas.scene import SupportPlane

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Seen:
    """An object's points in the camera's frame, the region of each, and the table."""

    points: Array
    region: NDArray[np.intp]
    plane: SupportPlane


@cache
def seen(class_name: str, number: int, noise: StereoNoise | None = None) -> Seen:
    """Return a random object of a class on a table."""
    thing = replace(variant(class_name, np.random.default_rng(number)), name=class_name)
    view = make_view(body_of(thing), number, seed=number)
    if noise is not None:
        view = view.with_noise(noise, np.random.default_rng(number))
    row, column = np.nonzero(view.on_object)
    z = view.depth[row, column] * 1e-4
    k = view.intrinsics
    points = np.column_stack([(column - k[0, 2]) / k[0, 0] * z, (row - k[1, 2]) / k[1, 1] * z, z])
    masks = view.regions[:, row, column]
    region = np.where(masks.any(axis=0), masks.argmax(axis=0), len(masks))
    normal = view.camera_from_world[:3, 2]
    origin = view.camera_from_world[:3, 3] + view.table_height * normal
    plane = SupportPlane(
        normal=(float(normal[0]), float(normal[1]), float(normal[2])),
        offset=-float(normal @ origin),
        inliers=1000,
        residual_mm=1.0,
    )
    return Seen(points, region, plane)


def overlap(labels: NDArray[np.int16], region: NDArray[np.bool_]) -> float:
    """Return the IoU of a region and the part that fits it best."""
    best = 0.0
    for part in range(int(labels.max()) + 1):
        own = labels == part
        best = max(best, float((own & region).sum() / (own | region).sum()))
    return best
