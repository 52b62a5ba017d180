"""The object's shape as convex parts: a mesh is cut where it is hollow, primitives are convex.

Approximate convex decomposition (Lien and Amato 2007): a piece whose surface lies
too deep below its hull is cut by a plane, until none does. PyBullet offers V-HACD
for this; it fills more of what is hollow (docs/decisions/0006-execution.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from services.execution.convex import ConvexPart, convex_hull
from services.execution.pieces import Piece, refined
from services.execution.shells import shells
from shared.errors import DegenerateCloud
from shared.superquadric import Superquadric, surface_mesh

Array = NDArray[np.float64]

TOLERANCE = 0.002
"""Metres that a surface may lie below its part's hull."""
MAX_PARTS = 24
MAX_SHELLS = 12
"""A model of more pieces is taken for a soup and cut as a whole."""


def parts_of_primitives(vectors: Sequence[Sequence[float]]) -> list[ConvexPart]:
    """Return one convex part per superquadric vector of Eq. 3.3 (e <= 2: all are convex).

    Raises
    ------
    DegenerateCloud
        None spans a volume.
    """
    meshes = (surface_mesh(Superquadric.from_vector(vector), 12, 24) for vector in vectors)
    hulls = [convex_hull(vertices) for vertices, _ in meshes]
    parts = [hull for hull in hulls if hull is not None]
    if not parts:
        raise _flat()
    return parts


def parts_of_mesh(vertices: Array, faces: NDArray[np.int32]) -> list[ConvexPart]:
    """Return convex parts (metres, the mesh's frame) that together cover a triangle mesh.

    Parameters
    ----------
    vertices, faces : (V, 3) and (F, 3) arrays
        Any triangle soup; it need not be closed, and its faces may have any sense.

    Raises
    ------
    DegenerateCloud
        The mesh spans no volume.
    """
    centre = vertices[faces].mean(axis=(0, 1))
    triangles = vertices[faces] - centre
    parts = _decompose(np.ascontiguousarray(triangles).tobytes())
    return [ConvexPart(part.vertices + centre, part.faces) for part in parts]


@lru_cache(maxsize=8)
def _decompose(triangles: bytes) -> tuple[ConvexPart, ...]:
    """Cut the worst piece until all are convex enough; remembered for the next grasp."""
    surface = np.frombuffer(triangles).reshape(-1, 3, 3)
    longest = float(np.ptp(surface, axis=(0, 1)).max()) / 20
    pieces = [Piece(refined(shell, longest)) for shell in _separate(surface)]
    while len(pieces) < MAX_PARTS:
        hollow = [piece for piece in pieces if piece.concavity > TOLERANCE]
        if not hollow:
            break
        worst = max(hollow, key=lambda piece: piece.void)
        pieces = [piece for piece in pieces if piece is not worst] + worst.divided()
    return tuple(piece.hull for piece in pieces if piece.hull is not None)


def _separate(surface: Array) -> list[Array]:
    """Return the shells that the surface consists of, or all as one when they are too many."""
    solid = [shell for shell in shells(surface) if convex_hull(shell.reshape(-1, 3)) is not None]
    if 1 <= len(solid) <= MAX_SHELLS:
        return solid
    if convex_hull(surface.reshape(-1, 3)) is None:
        raise _flat()
    return [surface]


def _flat() -> DegenerateCloud:
    return DegenerateCloud("the object spans no volume: its vertices lie in one plane")
