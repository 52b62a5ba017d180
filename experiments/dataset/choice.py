"""Which objects a dataset shows."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from experiments.catalogue import CATALOGUE, CatalogueObject, build, variant
from experiments.catalogue.mesh_folder import labelled_mesh, read_labels
from experiments.dataset.options import DatasetOptions
from experiments.dataset.randomness import generator
from experiments.dataset.view import MAX_TASKS
from shared.errors import InvalidInput

_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,99}")


def chosen_objects(options: DatasetOptions) -> tuple[CatalogueObject, ...]:
    """Return the objects: of the label file, or of the catalogue and then their classes' variants.

    Variant i of a class is called `<class>-v<i>`; it depends on the seed, the
    class and i alone.

    Raises
    ------
    InvalidInput
        An unknown name, one that makes no folder, meshes that cannot be used,
        or an object of more tasks than a label image can tell apart.
    """
    if options.meshes is None:
        things = list(_from_catalogue(options.objects))
    else:
        things = list(_from_meshes(options.meshes, options.objects))
    for class_name in dict.fromkeys(thing.class_name for thing in things):
        for index in range(options.variants):
            drawn = variant(class_name, generator(options.seed, f"variant of {class_name}", index))
            things.append(replace(drawn, name=f"{class_name}-v{index}"))
    for name in (thing.name for thing in things):
        if not _NAME.fullmatch(name):
            raise InvalidInput(
                f"object {name!r} cannot name a folder: letters, digits, '_', '-' and '.' can"
            )
    for thing in things:
        if len(thing.tasks) > MAX_TASKS:
            raise InvalidInput(f"object {thing.name!r} has more than {MAX_TASKS} tasks")
    # regions may be of a kind of mapping that other processes cannot be sent
    return tuple(replace(thing, regions=dict(thing.regions)) for thing in things)


def _from_catalogue(names: Sequence[str]) -> tuple[CatalogueObject, ...]:
    try:
        found = {thing.name: thing for thing in map(build, names or CATALOGUE)}
    except ValueError as error:
        raise InvalidInput(str(error), allowed=list(CATALOGUE)) from None
    return tuple(found[name] for name in CATALOGUE if name in found)


def _from_meshes(labels: Path, names: Sequence[str]) -> tuple[CatalogueObject, ...]:
    known = read_labels(labels)
    for name in names:
        if name not in known:
            raise InvalidInput(
                f"no object {name!r} in {labels}; known are {', '.join(known)}",
                allowed=list(known),
            )
    return tuple(
        labelled_mesh(name, label, labels.parent)
        for name, label in known.items()
        if not names or name in names
    )
