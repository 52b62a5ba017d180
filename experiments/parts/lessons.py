"""Which objects are shown, with which regions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from experiments.catalogue import CLASSES, CatalogueObject, variant
from experiments.dataset.randomness import generator
from experiments.parts.warp import doubled, warped

OTHER_REGIONS = {"bottle": {"pouring": ("body",), "handover": ("shoulder", "neck", "cap")}}
"""Where people disagree which part a border belongs to, the other opinion: whether
a bottle's shoulder is body or neck. Shown beside the catalogue's, as often, it teaches a
cut that both can live with."""

HANDLES = {"pan": "handle", "mug": "handle"}
"""Parts that some objects have two of."""

PLAIN = 0.3
"""Share of objects that are not warped."""


def lessons(seed: int, first: int, last: int) -> Iterator[CatalogueObject]:
    """Yield the objects of rounds `first` to `last` - 1, one or two of every class per round.

    An object depends on the seed, its class and the round alone.
    """
    for number in range(first, last):
        for class_name in CLASSES:
            rng = generator(seed, f"lesson on {class_name}", number)
            thing = variant(class_name, rng)
            if rng.random() > PLAIN:
                thing = warped(thing, rng)
            yield replace(thing, name=f"{class_name}-{number}")
            if class_name in OTHER_REGIONS:
                yield replace(
                    thing, name=f"{class_name}-{number}-b", regions=OTHER_REGIONS[class_name]
                )
            if class_name in HANDLES:
                twice = warped(doubled(variant(class_name, rng), HANDLES[class_name]), rng)
                yield replace(twice, name=f"double_{class_name}-{number}")


def noise_level(rng: np.random.Generator) -> tuple[float, float]:
    """Return a sensor's noise: sigma of the depth at 1 m in metres, correlation in pixels."""
    if rng.random() < 0.35:
        return 0.0, 0.0
    return float(rng.uniform(0.5e-3, 2.5e-3)), float(rng.choice([0.0, 0.0, 1.5]))
