"""The catalogue as the tables of docs/catalogue.md."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from experiments.catalogue.mass import mass_properties
from experiments.catalogue.model import CatalogueObject
from experiments.catalogue.objects import CATALOGUE, CLASSES, build

OBJECTS = ("object", "what it is", "size, mm", "mass, g", "held, by task")
REFUSALS = ("class", "tasks that it cannot serve")


def object_table() -> str:
    """Return one line per object: its name, extents, mass and regions."""
    return _table(OBJECTS, [_row(build(name)) for name in CATALOGUE])


def refusal_table() -> str:
    """Return one line per class: the tasks that it does not afford."""
    return _table(
        REFUSALS, [(name, ", ".join(kind.not_afforded)) for name, kind in CLASSES.items()]
    )


def _row(thing: CatalogueObject) -> tuple[str, ...]:
    size = " x ".join(f"{1e3 * extent:.0f}" for extent in np.ptp(thing.vertices, axis=0))
    mass = float(f"{1e3 * mass_properties(thing).mass:.2g}")
    regions = "; ".join(f"{task}: {', '.join(held)}" for task, held in thing.regions.items())
    return thing.name, thing.description, size, f"{mass:.0f}", regions


def _table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [header, ["---"] * len(header), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)
