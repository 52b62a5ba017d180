"""The object's shape as convex parts: a mesh is cut where it is hollow, primitives are convex.

Approximate convex decomposition (Lien and Amato 2007): of the pieces whose surface lies
too deep below their hull the one is cut that shrinks most by it, until none is left.
PyBullet offers V-HACD for this; it fills more of what is hollow
(docs/decisions/0006-execution.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from services.execution.convex import ConvexPart, convex_hull
from services.execution.pieces import Piece
from services.execution.shells import shells
from shared.errors import DegenerateCloud
from shared.superquadric import Superquadric, surface_mesh

Array = NDArray[np.float64]

TOLERANCE = 0.002
"""Metres that a surface may lie below its part's hull."""
MAX_PARTS = 48
LEAST_GAIN = 0.02
"""Share of its hull that a cut has to take away from a piece to be worth one part more."""
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
    """Cut the piece that gains most until all are convex enough; remembered for the next grasp."""
    surface = np.frombuffer(triangles).reshape(-1, 3, 3)
    pieces = [Piece.of(shell) for shell in _separate(surface)]
    while len(pieces) < MAX_PARTS and (worst := _most_to_gain(pieces)) is not None:
        pieces = [piece for piece in pieces if piece is not worst] + worst.divided()
    return tuple(piece.hull for piece in pieces if piece.hull is not None)


def _most_to_gain(pieces: Sequence[Piece]) -> Piece | None:
    """Return the piece whose division gains most; small ones cannot gain much, so large first."""
    worst, most = None, 0.0
    for piece in sorted(pieces, key=lambda piece: -piece.volume):
        if piece.volume <= most:
            break
        if piece.concavity <= TOLERANCE:
            continue
        gain = piece.division.gain
        if gain > max(most, LEAST_GAIN * piece.volume):
            worst, most = piece, gain
    return worst


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
