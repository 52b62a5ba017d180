"""Objects of exact cuboids, for comparison with closed forms."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from experiments.catalogue import CatalogueObject, Part
from experiments.catalogue.model import Mesh

Size = tuple[float, float, float]

_FACES = np.array(
    [
        [0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
        [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5],
    ],
    dtype=np.int32,
)  # fmt: skip


def cuboid(size: Size, centre: ArrayLike = (0, 0, 0)) -> Mesh:
    """A box with sharp edges, metres."""
    corners = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]) / 2
    return Mesh(corners * size + np.asarray(centre), _FACES)


def brick(size: Size, name: str = "brick", density: float = 1000.0) -> CatalogueObject:
    """One cuboid about the origin, all of it to be held."""
    return CatalogueObject(
        name, "", (Part("all", (cuboid(size),), density),), {"lifting": ("all",)}
    )


def row(
    size: Size,
    densities: Mapping[str, float],
    regions: Mapping[str, tuple[str, ...]],
    name: str = "row",
) -> CatalogueObject:
    """Cuboids of one size side by side along x, a part each, the first about the origin."""
    parts = tuple(
        Part(part, (cuboid(size, (index * size[0], 0, 0)),), density)
        for index, (part, density) in enumerate(densities.items())
    )
    return CatalogueObject(name, "", parts, regions)
