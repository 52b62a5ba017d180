"""What an ideal depth camera sees, by ray casting; no window, no graphics card."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import open3d as o3d
from numpy.typing import NDArray

from experiments.camera.pinhole import PinholeCamera
from experiments.camera.scene import Table
from experiments.catalogue import CatalogueObject
from shared.geometry.se3 import inverse, transform_points

Array = NDArray[np.float64]

BACKGROUND, TABLE, FIRST_REGION = 0, 1, 2
"""Labels of a label image."""

_BOX_FACES = np.array(
    [
        [0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
        [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5],
    ],
    dtype=np.uint32,
)  # fmt: skip


@dataclass(frozen=True)
class Rendering:
    """One view.

    Attributes
    ----------
    depth : (H, W) float64 array
        Metres along the optical axis; 0 where nothing is hit.
    part : (H, W) int16 array
        Index of the object's part at each pixel, -1 elsewhere.
    on_table : (H, W) bool array
        Where the table is seen. Where other things are seen there is a depth,
        but neither a part nor the table.
    """

    depth: Array
    part: NDArray[np.int16]
    on_table: NDArray[np.bool_]


def render(
    thing: CatalogueObject,
    world_from_object: Array,
    table: Table,
    camera: PinholeCamera,
    world_from_camera: Array,
    others: Sequence[tuple[CatalogueObject, Array]] = (),
) -> Rendering:
    """Return what the camera sees of an object on a table.

    Parameters
    ----------
    thing : CatalogueObject
        The object that parts and labels refer to.
    world_from_object, world_from_camera : (4, 4) array
        Poses in the world's frame.
    table : Table
        The table in that frame.
    camera : PinholeCamera
        The camera.
    others : sequence of (CatalogueObject, (4, 4) array), optional
        What else stands about, each with its world_from_object. It is seen and
        it hides, but it is no part of `thing`.

    Notes
    -----
    One thread, so that the same scene gives the same bytes everywhere; views
    are made in parallel by processes (experiments.dataset).
    """
    scene = o3d.t.geometry.RaycastingScene(nthreads=1)
    low, high = table.corners
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)])
    camera_from_world = inverse(world_from_camera)
    _add(scene, transform_points(camera_from_world, low + corners * (high - low)), _BOX_FACES)
    part_of_geometry = [-1]
    camera_from_object = camera_from_world @ world_from_object
    for index, part in enumerate(thing.parts):
        for mesh in part.meshes:
            _add(scene, transform_points(camera_from_object, mesh.vertices), mesh.faces)
            part_of_geometry.append(index)
    for other, world_from_other in others:
        camera_from_other = camera_from_world @ world_from_other
        for part in other.parts:
            for mesh in part.meshes:
                _add(scene, transform_points(camera_from_other, mesh.vertices), mesh.faces)
                part_of_geometry.append(-1)
    directions = camera.rays()
    rays = np.concatenate([np.zeros_like(directions), directions], axis=-1)
    hit = scene.cast_rays(o3d.core.Tensor.from_numpy(rays.astype(np.float32)), nthreads=1)
    distance = hit["t_hit"].numpy().astype(np.float64)
    seen = np.isfinite(distance)
    geometry = np.where(seen, hit["geometry_ids"].numpy(), 0).astype(np.int64)
    part_index = np.where(seen, np.asarray(part_of_geometry, dtype=np.int16)[geometry], -1)
    return Rendering(
        depth=np.where(seen, distance, 0.0),
        part=part_index.astype(np.int16),
        on_table=seen & (geometry == 0),
    )


def region_masks(thing: CatalogueObject, rendering: Rendering) -> NDArray[np.bool_]:
    """Return (T, H, W) where the region of each of the T tasks is seen.

    A region is the union of its parts, however many pieces it shows; a part
    that serves several tasks is in the region of each.
    """
    names = [part.name for part in thing.parts]
    in_region = np.zeros((len(thing.tasks), len(names) + 1), dtype=bool)  # last: part -1
    for index, task in enumerate(thing.tasks):
        in_region[index, [names.index(name) for name in thing.regions[task]]] = True
    return np.asarray(in_region[:, rendering.part])


def label_image(thing: CatalogueObject, rendering: Rendering) -> NDArray[np.uint8]:
    """Return the labels (H, W): 0 background, 1 table, 2 + i the region of task i.

    A part in no task's region gets 2 + the number of tasks. Where regions of
    several tasks overlap, the first task's label stands.
    """
    names = [part.name for part in thing.parts]
    of_part = np.full(len(names) + 1, FIRST_REGION + len(thing.tasks), dtype=np.uint8)
    for index, task in reversed(list(enumerate(thing.tasks))):
        of_part[[names.index(name) for name in thing.regions[task]]] = FIRST_REGION + index
    of_part[-1] = BACKGROUND  # part -1
    return np.where(rendering.on_table, np.uint8(TABLE), of_part[rendering.part])


def _add(
    scene: o3d.t.geometry.RaycastingScene, vertices: Array, faces: NDArray[np.generic]
) -> None:
    scene.add_triangles(
        o3d.core.Tensor.from_numpy(np.ascontiguousarray(vertices, dtype=np.float32)),
        o3d.core.Tensor.from_numpy(np.ascontiguousarray(faces, dtype=np.uint32)),
    )
