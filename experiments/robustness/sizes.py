"""The same object in another size of its class."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull
from scipy.spatial.distance import pdist

from experiments.camera import D435, Table
from experiments.catalogue import CATALOGUE, CLASSES, CatalogueObject, build, variant
from experiments.dataset.photograph import photograph
from experiments.dataset.scene import IMAGE_MARGIN_PX, Scene, in_image, on_table
from experiments.framework import ShownView
from shared.geometry.se3 import inverse, pose_matrix, transform_points

Array = NDArray[np.float64]

TRIES = 20
"""Sizes that are drawn until one fits onto the table and into the picture."""


def of_other_size(view: ShownView, rng: np.random.Generator) -> ShownView | None:
    """Return the view of the object, scaled as a whole to the size of another one of its class.

    Its largest extent becomes that of a random variant of the class, so the sizes
    are those that the class has. It lies as before: same rotation, lowest point on
    the table, centre of mass over the same point. Only the object changes; table and
    camera stay, so unlike a scaled depth image this is no view from another distance.

    Returns
    -------
    ShownView or None
        None for an object that is not in the catalogue, or too large in every size
        that was drawn.
    """
    seen = view.view
    if seen.object_name not in CATALOGUE:
        return None
    thing = build(seen.object_name)
    if thing.class_name not in CLASSES:
        return None
    table, own = Table(height=seen.table_height), largest_extent(thing)
    world_from_camera = inverse(seen.camera_from_world)
    for _ in range(TRIES):
        factor = largest_extent(variant(thing.class_name, rng)) / own
        other = scaled(thing, factor)
        placed = _in_place(thing, other, world_from_camera @ seen.camera_from_object, table)
        vertices = transform_points(placed, other.vertices)
        if on_table(vertices, table) and in_image(
            transform_points(seen.camera_from_world, vertices), D435, IMAGE_MARGIN_PX
        ):
            scene = Scene(table, placed, world_from_camera)
            return ShownView(photograph(other, seen.number, scene))
    return None


def largest_extent(thing: CatalogueObject) -> float:
    """Return the largest distance between two points of an object, metres."""
    vertices = thing.vertices
    return float(pdist(vertices[ConvexHull(vertices).vertices]).max())


def scaled(thing: CatalogueObject, factor: float) -> CatalogueObject:
    """Return the object with all its lengths times `factor`."""
    return replace(
        thing,
        parts=tuple(
            replace(
                part,
                meshes=tuple(
                    replace(mesh, vertices=factor * mesh.vertices) for mesh in part.meshes
                ),
            )
            for part in thing.parts
        ),
        balance=None if thing.balance is None else _times(factor, thing.balance),
    )


def _times(factor: float, point: tuple[float, float, float]) -> tuple[float, float, float]:
    x, y, z = point
    return factor * x, factor * y, factor * z


def _in_place(
    thing: CatalogueObject, other: CatalogueObject, world_from_thing: Array, table: Table
) -> Array:
    """Return world_from_other (4, 4): turned and centred as `thing` is, at rest on the table."""
    rotation = world_from_thing[:3, :3]
    centre = transform_points(world_from_thing, thing.centre_of_mass[None])[0]
    x, y, _ = centre - rotation @ other.centre_of_mass
    lowest = float((other.vertices @ rotation[2]).min())
    return pose_matrix((x, y, table.height - lowest), rotation)
