"""A scene through the camera: a noiseless labelled view."""

from __future__ import annotations

from experiments.camera import D435, label_image, region_masks, render
from experiments.catalogue import CatalogueObject
from experiments.dataset.scene import Scene
from experiments.dataset.view import LabelledView, to_depth_units


def photograph(thing: CatalogueObject, number: int, scene: Scene) -> LabelledView:
    """Return what the head camera sees of an object on a table, as view `number` of it."""
    ideal = render(thing, scene.world_from_object, scene.table, D435, scene.world_from_camera)
    return LabelledView(
        object_name=thing.name,
        number=number,
        depth=to_depth_units(ideal.depth),
        label=label_image(thing, ideal),
        intrinsics=D435.intrinsics,
        tasks=thing.tasks,
        regions=region_masks(thing, ideal),
        camera_from_object=scene.camera_from_object,
        camera_from_world=scene.camera_from_world,
        table_height=scene.table.height,
    )
