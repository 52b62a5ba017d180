"""Which primitives an object should be made of: the boxes around its parts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from experiments.catalogue import CatalogueObject
from experiments.framework.boxes import smallest_box


@dataclass(frozen=True)
class ExpectedPrimitive:
    """One that a perfect recovery would find.

    Attributes
    ----------
    parts : tuple of str
        The parts of the object that it stands for.
    size : tuple of float
        Edge lengths of their smallest box in any orientation, ascending, metres.
    position : tuple of float
        Its centre in the object's frame, metres.
    """

    parts: tuple[str, ...]
    size: tuple[float, float, float]
    position: tuple[float, float, float]


def expected_primitives(thing: CatalogueObject) -> tuple[ExpectedPrimitive, ...]:
    """Return one primitive for all parts that are held for the same tasks.

    A primitive is what a rule tells apart: a bottle's body and shoulder are held
    for pouring, its neck and cap for handover, so it should be two, as every
    object of the thesis. Parts that are held for nothing make one of their own.
    """
    groups: dict[frozenset[str], list[str]] = {}
    for name in thing.part_names:
        held = frozenset(task for task, parts in thing.regions.items() if name in parts)
        groups.setdefault(held, []).append(name)
    return tuple(_around(thing, tuple(names)) for names in groups.values())


def _around(thing: CatalogueObject, names: tuple[str, ...]) -> ExpectedPrimitive:
    vertices = np.concatenate(
        [mesh.vertices for part in thing.parts if part.name in names for mesh in part.meshes]
    )
    box = smallest_box(vertices)
    a, b, c = box.lengths.tolist()
    x, y, z = box.centre.tolist()
    return ExpectedPrimitive(names, (a, b, c), (x, y, z))
