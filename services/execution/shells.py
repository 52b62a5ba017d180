"""The closed shells of a triangle mesh, each turned so that its faces point outward.

Models for rendering hold faces twice, once for each side, faces of any sense, and
shells that run through each other; what is hollow is only seen when the sense is right.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import breadth_first_order, connected_components

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

SAME = 1e-7
"""Metres: corners this close are one."""


def shells(triangles: Array) -> list[Array]:
    """Return the connected parts (T_i, 3, 3) of a triangle mesh, largest first, facing outward.

    A face that is there twice counts once. Neighbours are turned to agree with each
    other, and a shell as a whole so that it encloses a positive volume.

    Parameters
    ----------
    triangles : (T, 3, 3) array
        Corners, metres.
    """
    faces, kept = _faces(triangles)
    triangles = triangles[kept]
    if len(faces) == 0:
        return []
    first, second, turned = _neighbours(faces)
    links = coo_matrix((np.ones(len(first)), (first, second)), shape=(len(faces),) * 2).tocsr()
    count, label = connected_components(links, directed=False)
    if turned.any():
        flip = _flips(len(faces), first, second, turned, label.astype(np.int64))
        triangles = np.where(flip[:, None, None], triangles[:, ::-1], triangles)
    parts = [triangles[label == each] for each in range(count)]
    return sorted((_outward(part) for part in parts), key=lambda part: -len(part))


def _faces(triangles: Array) -> tuple[Ints, Ints]:
    """Return corner numbers (U, 3) of the different proper faces, and which they are (U,)."""
    corners = np.round(triangles.reshape(-1, 3) / SAME).astype(np.int64)
    _, number = np.unique(corners, axis=0, return_inverse=True)
    faces = number.reshape(-1, 3)
    ordered = np.sort(faces, axis=1)
    proper = np.flatnonzero((ordered[:, 1:] != ordered[:, :-1]).all(axis=1))
    _, once = np.unique(ordered[proper], axis=0, return_index=True)
    kept = np.sort(proper[once])
    return faces[kept], kept


def _neighbours(faces: Ints) -> tuple[Ints, Ints, NDArray[np.bool_]]:
    """Return pairs of faces (E,), (E,) that share an edge, and whether their senses differ (E,)."""
    edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    forward = edges[:, 0] < edges[:, 1]
    owner = np.repeat(np.arange(len(faces)), 3)
    key = np.sort(edges, axis=1)
    order = np.lexsort((key[:, 1], key[:, 0]))
    same = (key[order[1:]] == key[order[:-1]]).all(axis=1)
    a, b = order[:-1][same], order[1:][same]
    return owner[a], owner[b], forward[a] == forward[b]


def _flips(
    count: int, first: Ints, second: Ints, turned: NDArray[np.bool_], label: Ints
) -> NDArray[np.bool_]:
    """Return which faces (count,) to turn so that neighbours agree along a spanning tree."""
    weights = np.where(turned, 2.0, 1.0)
    both = coo_matrix(
        (np.tile(weights, 2), (np.r_[first, second], np.r_[second, first])), shape=(count,) * 2
    )
    links = both.tocsr()
    flip = np.zeros(count, dtype=np.bool_)
    for each in range(int(label.max()) + 1):
        root = int(np.argmax(label == each))
        order, before = breadth_first_order(links, root, directed=False)
        if len(order) == 1:
            continue
        relation = np.asarray(links[before[order[1:]], order[1:]]).ravel()
        for face, differs in zip(order[1:].tolist(), (relation == 2.0).tolist(), strict=True):
            flip[face] = flip[before[face]] ^ differs
    return flip


def _outward(shell: Array) -> Array:
    about_middle = shell - shell.mean(axis=(0, 1))
    return shell[:, ::-1] if np.linalg.det(about_middle).sum() < 0 else shell
