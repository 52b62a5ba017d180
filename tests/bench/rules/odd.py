"""Objects of the catalogue's classes in proportions that nobody would build them in."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from experiments.catalogue import (
    CLASSES,
    CatalogueObject,
    bottles,
    cutlery,
    hammers,
    ladles,
    pans,
    scissors,
    screwdrivers,
    turners,
    variant,
    vessels,
)

ODD = 0.45
"""Natural logarithm of the largest factor on any measure."""

_TRIES = 20
_BUILDERS: dict[str, tuple[Callable[..., CatalogueObject], ...]] = {
    "pan": (pans.saucepan, pans.frying_pan, pans.skillet),
    "ladle": (ladles.ladle, ladles.hooked_ladle, ladles.serving_ladle),
    "hammer": (hammers.hammer, hammers.framing_hammer, hammers.ball_peen, hammers.mallet),
    "spatula": (turners.spatula, turners.solid_turner, turners.fish_turner),
    "bottle": (bottles.bottle, bottles.wine_bottle, bottles.squeeze_bottle),
    "knife": (cutlery.knife,),
    "spoon": (cutlery.spoon,),
    "scissors": (scissors.scissors,),
    "screwdriver": (screwdrivers.screwdriver,),
    "mug": (vessels.mug,),
}
_SHARES = ("_share", "fullness", "tip_drop", "belly", "density", "wall", "edge")
"""Arguments that are no lengths of the shape, by the end of their name."""


def odd(class_name: str, rng: np.random.Generator) -> CatalogueObject:
    """Return an object of a class, every measure of it on its own up to 1.6 times off.

    So handles are too long or too short, heads too small, bowls too deep. Classes
    without parts (can, box, bowl) are drawn as `variant` draws them.
    """
    if class_name not in _BUILDERS:
        return variant(class_name, rng)
    builders = _BUILDERS[class_name]
    for _ in range(_TRIES):
        builder = builders[int(rng.integers(len(builders)))]
        measures = {
            name: float(default) * float(np.exp(rng.uniform(-ODD, ODD)))
            for name, default in _measures(builder)
        }
        try:
            thing = builder(**measures)
            if np.isfinite(thing.vertices).all():
                return _classified(thing, class_name)
        except (ValueError, AssertionError, FloatingPointError):
            continue  # a neck wider than its bottle
    return variant(class_name, rng)


def _measures(builder: Callable[..., CatalogueObject]) -> list[tuple[str, float]]:
    parameters = inspect.signature(builder).parameters.values()
    return [
        (each.name, each.default)
        for each in parameters
        if isinstance(each.default, float) and not each.name.endswith(_SHARES)
    ]


def _classified(thing: CatalogueObject, class_name: str) -> CatalogueObject:
    return replace(thing, class_name=class_name, not_afforded=CLASSES[class_name].not_afforded)
