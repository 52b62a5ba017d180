"""Objects as nobody built them: catalogue variants, stretched, tapered, bent and sheared."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from experiments.catalogue import CatalogueObject, Mesh, Part

Array = NDArray[np.float64]

STRETCH = 0.28
"""Natural logarithm of the largest stretch along any axis."""
CREEP = 0.55
"""Largest change of the local scale along the object's length."""
TAPER = 0.28
"""Largest change of the cross-section along it."""
BEND, SHEAR = 0.12, 0.08
"""Standard deviations of the offset at the ends, as a share of half the length."""


def warped(thing: CatalogueObject, rng: np.random.Generator) -> CatalogueObject:
    """Return the object with its vertices moved by a smooth random map; its parts stay.

    Mostly along its longest axis: scale creeps along it, the cross-section
    swells and shrinks, and half of the objects bend or lean. Then every axis
    is stretched on its own.
    """
    low, high = thing.vertices.min(axis=0), thing.vertices.max(axis=0)
    middle, half = (low + high) / 2, (high - low) / 2
    axis = int(half.argmax()) if rng.random() > 0.3 else int(rng.integers(3))
    across = [k for k in range(3) if k != axis]
    stretch = np.exp(rng.uniform(-STRETCH, STRETCH, 3))
    waves, phase, creep = rng.uniform(0.5, 1.6), rng.uniform(0, 2 * np.pi), rng.uniform(0, CREEP)
    swells = rng.uniform(0.3, 1.3, 2)
    starts = rng.uniform(0, 2 * np.pi, 2)
    swell = rng.uniform(0, TAPER, 2)
    bend = rng.normal(0, BEND) * (rng.random() < 0.5)
    shear = rng.normal(0, SHEAR) * (rng.random() < 0.4)

    def moved(vertices: Array) -> Array:
        placed = vertices - middle
        along = placed[:, axis] / half[axis]
        for k, one in enumerate(across):
            placed[:, one] *= 1 + swell[k] * np.sin(np.pi * swells[k] * along + starts[k])
        placed[:, across[0]] += half[axis] * (bend * along**2 + shear * along)
        crept = np.sin(np.pi * waves * along + phase) - np.sin(phase)
        placed[:, axis] = half[axis] * (along + creep * crept / (np.pi * waves))
        return np.asarray(placed * stretch)

    return replace(
        thing,
        parts=tuple(
            replace(
                part, meshes=tuple(Mesh(moved(mesh.vertices), mesh.faces) for mesh in part.meshes)
            )
            for part in thing.parts
        ),
        balance=None,
    )


def doubled(thing: CatalogueObject, part: str) -> CatalogueObject:
    """Return the object with a second copy of a part, turned by 180 degrees about z.

    The first stays; the copy is a part and a region of its own. A pot with two
    handles, a cup with two ears.

    Raises
    ------
    ValueError
        The object has no such part.
    """
    if part not in thing.part_names:
        raise ValueError(f"{thing.name} has no part {part!r}, it has {thing.part_names}")
    original = thing.parts[thing.part_names.index(part)]
    rest = np.concatenate(
        [m.vertices for other in thing.parts if other.name != part for m in other.meshes]
    )
    centre = (rest.min(axis=0) + rest.max(axis=0)) / 2
    turn = np.array([-1.0, -1.0, 1.0])
    copy = Part(
        f"second_{part}",
        tuple(
            Mesh((mesh.vertices - centre) * turn + centre, mesh.faces) for mesh in original.meshes
        ),
        original.density,
    )
    return replace(
        thing,
        parts=(*thing.parts, copy),
        regions={**thing.regions, "second": (copy.name,)},
        balance=None,
    )
