"""A studio photograph of one object, by ray casting: no window, no graphics card."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import open3d as o3d
from numpy.typing import NDArray

from experiments.catalogue import CatalogueObject
from shared.geometry.rotation import unit

Array = NDArray[np.float64]

KEY_LIGHT = unit([-0.45, 0.55, 0.75])
"""Towards the light: left, up, towards the camera."""
FOCAL = 4.0
"""Distance of the camera in units of half the picture's width: a short telephoto lens."""
CREASE_DEG = 35.0
FILLED = 0.94
"""Share of the picture that the object takes."""
OCCLUSION_RAYS, OCCLUSION_REACH = 24, 0.25


def photograph(
    thing: CatalogueObject, colours: Sequence[tuple[float, float, float]], size: int
) -> Array:
    """Return a picture (size, size, 4) of an object, red green blue alpha in [0, 1].

    Parameters
    ----------
    thing : CatalogueObject
        Any.
    colours : sequence
        One per part.
    size : int
        Pixels; each is the mean of four rays.
    """
    surface = thing.surface
    camera_from_object = viewing_rotation(thing)
    placed = surface.vertices @ camera_from_object.T
    placed = _framed(placed)
    corners = placed[surface.faces]
    face_normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    vertex_normals = np.zeros_like(placed)
    for k in range(3):
        np.add.at(vertex_normals, surface.faces[:, k], face_normals)
    face_normals, vertex_normals = _normalised(face_normals), _normalised(vertex_normals)
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(
        o3d.core.Tensor.from_numpy(placed.astype(np.float32)),
        o3d.core.Tensor.from_numpy(surface.faces.astype(np.uint32)),
    )
    origin, direction = _rays(2 * size)
    hit = scene.cast_rays(_tensor(origin, direction))
    reach, face = hit["t_hit"].numpy(), hit["primitive_ids"].numpy()
    seen = np.isfinite(reach)
    face = face[seen].astype(np.int64)
    u, v = hit["primitive_uvs"].numpy()[seen].T.astype(np.float64)
    weights = np.stack([1 - u - v, u, v], axis=-1)
    smooth = _normalised((vertex_normals[surface.faces[face]] * weights[..., None]).sum(axis=1))
    flat = face_normals[face]
    crease = np.einsum("ij,ij->i", smooth, flat) < np.cos(np.radians(CREASE_DEG))
    normals = np.where(crease[:, None], flat, smooth)
    point = (origin + direction * np.where(seen, reach, 0.0)[:, None])[seen] + 2e-3 * flat
    light = _light(scene, point, normals, unit(direction[seen]))
    picture = np.zeros((4 * size * size, 4))
    base = np.asarray(colours)[surface.part[face]]
    picture[seen, :3] = np.clip(base * light[:, :1] + light[:, 1:], 0, 1)
    picture[seen, 3] = 1.0
    picture[:, :3] *= picture[:, 3:]
    small = picture.reshape(size, 2, size, 2, 4).mean(axis=(1, 3))
    small[..., :3] /= np.maximum(small[..., 3:], 1e-9)
    return np.asarray(small)


def _framed(vertices: Array) -> Array:
    """Return vertices (V, 3) moved and scaled such that their picture fills [-1, 1] nearly."""
    centre = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    placed = (vertices - centre) / np.ptp(vertices, axis=0)[:2].max()
    for _ in range(4):
        seen = placed[:, :2] * (FOCAL / (FOCAL - placed[:, 2:]))
        low, high = seen.min(axis=0), seen.max(axis=0)
        placed = (placed - [*(low + high) / 2, 0.0]) * (2 * FILLED / (high - low).max())
    return np.asarray(placed)


def viewing_rotation(thing: CatalogueObject) -> Array:
    """Return camera_from_object (3, 3), x right, y up, z towards the camera.

    Upright things are seen from a little above, flat ones from further along
    their thin direction, and the long axis lies across the picture.
    """
    extent = np.ptp(thing.vertices, axis=0)
    thin, long = int(extent.argmin()), int(extent.argmax())
    towards, up = np.array([0.50, -0.72, 0.52]), np.array([0.0, 0.0, 1.0])
    middle = 3 - thin - long
    flat = extent[thin] < 0.42 * extent[middle] and extent[middle] < 0.85 * extent[long]
    if flat and long != 2:
        towards = np.full(3, 0.30)
        towards[long] *= -0.8
        towards[thin] = -0.95 if thin == 1 else 0.95
        up = np.eye(3)[middle]
    z = unit(towards)
    x = unit(np.cross(up, z))
    rotation = np.stack([x, np.cross(z, x), z])
    if long != 2 and extent[long] > 2 * extent[middle] and extent[2] < 0.3 * extent[long]:
        across = rotation @ np.eye(3)[long]
        turn = np.radians(38) - np.arctan2(across[1], across[0])
        c, s = np.cos(turn), np.sin(turn)
        rotation = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ rotation
    return np.asarray(rotation)


def _light(scene: o3d.t.geometry.RaycastingScene, point: Array, normal: Array, ray: Array) -> Array:
    """Return (N, 4): what the surface's colour is multiplied by, and the highlight to add."""
    shadow = ~_blocked(scene, point, np.broadcast_to(KEY_LIGHT, point.shape), 10.0)
    key = np.clip(normal @ KEY_LIGHT, 0, 1) * (0.35 + 0.65 * shadow)
    height = 1 - 2 * (np.arange(OCCLUSION_RAYS) + 0.5) / OCCLUSION_RAYS
    angle, flat = 2.399963 * np.arange(OCCLUSION_RAYS), np.sqrt(1 - height**2)  # golden angle
    sphere = 0.999 * np.column_stack([flat * np.cos(angle), flat * np.sin(angle), height])
    open_ = np.zeros(len(point))
    for direction in sphere:  # the normal plus a point of the unit sphere: a cosine lobe
        open_ += ~_blocked(scene, point, unit(normal + direction), OCCLUSION_REACH)
    open_ /= OCCLUSION_RAYS
    half = unit(KEY_LIGHT - ray)
    gloss = 0.25 * np.clip(np.einsum("ij,ij->i", normal, half), 0, 1) ** 40 * shadow
    diffuse = open_ * (0.58 + 0.14 * normal[:, 1]) + 0.50 * key
    return np.column_stack([diffuse, gloss, gloss, gloss])


def _blocked(
    scene: o3d.t.geometry.RaycastingScene, point: Array, direction: Array, reach: float
) -> NDArray[np.bool_]:
    hit = scene.test_occlusions(_tensor(point, direction), tfar=reach)
    return np.asarray(hit.numpy(), dtype=bool)


def _rays(size: int) -> tuple[Array, Array]:
    """Return origins and directions (size * size, 3), row by row from the top left."""
    step = (np.arange(size) + 0.5) / size * 2 - 1
    x, y = np.meshgrid(step, -step)
    direction = np.stack([x, y, np.full_like(x, -FOCAL)], axis=-1).reshape(-1, 3)
    return np.broadcast_to([0.0, 0.0, FOCAL], direction.shape), direction


def _tensor(origin: Array, direction: Array) -> o3d.core.Tensor:
    return o3d.core.Tensor.from_numpy(np.hstack([origin, direction]).astype(np.float32))


def _normalised(vectors: Array) -> Array:
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.maximum(lengths, 1e-12))
