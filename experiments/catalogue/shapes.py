"""Closed meshes by lofting, sweeping and revolving profiles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from experiments.catalogue.model import Mesh
from shared.geometry.rotation import unit

Array = NDArray[np.float64]
Indices = NDArray[np.int32]

SEGMENTS = 32


def superellipse(
    width: float, height: float, exponent: float = 2.0, segments: int = SEGMENTS
) -> Array:
    """Return a cross-section (segments, 2), counter-clockwise, `width` x `height` metres.

    |2x/width|^n + |2y/height|^n = 1: n = 2 is an ellipse, a large n a rounded rectangle.
    """
    angle = (np.arange(segments) + 0.5) * (2 * np.pi / segments)
    axes = np.column_stack([np.cos(angle), np.sin(angle)])
    rim = np.sign(axes) * np.abs(axes) ** (2 / exponent)
    return np.asarray(rim * np.array([width, height]) / 2)


def loft(rings: Sequence[Array] | Array, *, closed: bool = False) -> Mesh:
    """Return the mesh through these rings of points, each (S, 3) and convex.

    The rings turn counter-clockwise when seen against the direction in which
    they follow each other. The ends are covered by fans about their centres,
    or joined to one another when `closed`.
    """
    stack = np.asarray(rings, dtype=np.float64)
    count, segments = stack.shape[:2]
    index = np.arange(count * segments, dtype=np.int32).reshape(count, segments)
    low = index if closed else index[:-1]
    high = np.roll(index, -1, axis=0) if closed else index[1:]
    faces = [*_quads(low, high)]
    vertices = [stack.reshape(-1, 3)]
    if not closed:
        first, last = count * segments, count * segments + 1
        vertices += [stack[0].mean(axis=0, keepdims=True), stack[-1].mean(axis=0, keepdims=True)]
        faces += [_fan(first, index[0][::-1]), _fan(last, index[-1])]
    return Mesh(np.concatenate(vertices), np.concatenate(faces).astype(np.int32))


def sweep(
    spine: ArrayLike, sections: Sequence[Array], side: ArrayLike, *, closed: bool = False
) -> Mesh:
    """Return the mesh of cross-sections carried along a spine.

    Parameters
    ----------
    spine : (K, 3) array_like
        Where the centres of the sections are.
    sections : sequence of (S, 2) array
        One per point of the spine.
    side : (3,) array_like
        The sections' first axis points here, as far as the spine allows.
    closed : bool
        The spine's end joins its start.
    """
    path = np.asarray(spine, dtype=np.float64)
    if closed:
        tangents = np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0)
    else:
        tangents = np.gradient(path, axis=0)
    z = unit(tangents)
    hint = np.broadcast_to(np.asarray(side, dtype=np.float64), z.shape)
    x = unit(hint - z * np.einsum("ij,ij->i", hint, z)[:, None])
    y = np.cross(z, x)
    rings = [
        centre + section[:, :1] * across + section[:, 1:] * along
        for centre, section, across, along in zip(path, sections, x, y, strict=True)
    ]
    return loft(rings, closed=closed)


def revolve(profile: ArrayLike, segments: int = 64) -> Mesh:
    """Return the mesh of a profile turned about z.

    Parameters
    ----------
    profile : (K, 2) array_like
        Radius and height in metres, from axis to axis (the first and the last
        radius are 0), such that the solid lies to the left.
    segments : int
        Number of steps about the axis.
    """
    path = np.asarray(profile, dtype=np.float64)
    angle = np.arange(segments) * (2 * np.pi / segments)
    radius, height = path[1:-1, :1], np.broadcast_to(path[1:-1, 1:], (len(path) - 2, segments))
    ring = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=-1)
    index = np.arange(ring[..., 0].size, dtype=np.int32).reshape(height.shape)
    first, last = index.size, index.size + 1
    ends = np.array([[0, 0, path[0, 1]], [0, 0, path[-1, 1]]])
    faces = [*_quads(index[:-1], index[1:]), _fan(first, index[0][::-1]), _fan(last, index[-1])]
    return Mesh(np.concatenate([ring.reshape(-1, 3), ends]), np.concatenate(faces).astype(np.int32))


def box(size: ArrayLike, centre: ArrayLike, exponent: float = 12.0) -> Mesh:
    """Return a box (3,) metres large about `centre` (3,), its edges along x slightly rounded."""
    length, width, height = np.asarray(size, dtype=np.float64)
    spine = np.asarray(centre) + np.outer([-0.5, 0.5], [length, 0, 0])
    return sweep(spine, [superellipse(width, height, exponent)] * 2, side=(0, 1, 0))


def scaled(mesh: Mesh, factors: ArrayLike) -> Mesh:
    """Return the mesh stretched by positive factors (3,) about the origin."""
    return Mesh(mesh.vertices * np.asarray(factors), mesh.faces)


def moved(mesh: Mesh, offset: ArrayLike, rotation: ArrayLike | None = None) -> Mesh:
    """Return the mesh turned by `rotation` (3, 3) about the origin, then shifted by `offset`."""
    turn = np.eye(3) if rotation is None else np.asarray(rotation)
    return Mesh(mesh.vertices @ turn.T + np.asarray(offset), mesh.faces)


def _quads(low: Indices, high: Indices) -> tuple[Indices, Indices]:
    low_next, high_next = np.roll(low, -1, axis=1), np.roll(high, -1, axis=1)
    one = np.stack([low, low_next, high_next], axis=-1).reshape(-1, 3)
    two = np.stack([low, high_next, high], axis=-1).reshape(-1, 3)
    return one, two


def _fan(centre: int, ring: Indices) -> Indices:
    hub = np.full(len(ring), centre, dtype=np.int32)
    return np.stack([hub, ring, np.roll(ring, -1)], axis=1)
