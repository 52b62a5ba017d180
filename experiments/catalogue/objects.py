"""The objects, by name and by class."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from experiments.catalogue.bottles import any_bottle, bottle, squeeze_bottle, wine_bottle
from experiments.catalogue.cutlery import any_knife, any_spoon, knife, spoon
from experiments.catalogue.hammers import any_hammer, ball_peen, framing_hammer, hammer
from experiments.catalogue.ladles import any_ladle, hooked_ladle, ladle, serving_ladle
from experiments.catalogue.model import STEEL, CatalogueObject
from experiments.catalogue.packages import (
    any_box,
    any_can,
    box,
    drinks_can,
    food_can,
    lidded_box,
)
from experiments.catalogue.pans import any_pan, frying_pan, saucepan, skillet
from experiments.catalogue.scissors import any_scissors, scissors
from experiments.catalogue.screwdrivers import any_screwdriver, screwdriver
from experiments.catalogue.turners import any_spatula, fish_turner, solid_turner, spatula
from experiments.catalogue.vessels import any_bowl, any_mug, bowl, mug

Builder = Callable[[], CatalogueObject]


@dataclass(frozen=True)
class ObjectClass:
    """A class of objects.

    Attributes
    ----------
    builders : tuple
        Its objects; the first is <class>1.
    variant : callable
        Draws a random one.
    not_afforded : tuple of str
        Tasks that none of its objects can serve, beyond doubt.
    """

    builders: tuple[Builder, ...]
    variant: Callable[[np.random.Generator], CatalogueObject]
    not_afforded: tuple[str, ...]


CLASSES: Mapping[str, ObjectClass] = MappingProxyType(
    {
        "pan": ObjectClass((saucepan, frying_pan, skillet), any_pan, ("cutting",)),
        "ladle": ObjectClass(
            (ladle, hooked_ladle, serving_ladle), any_ladle, ("cutting", "hammering")
        ),
        "hammer": ObjectClass(
            (hammer, ball_peen, framing_hammer),
            any_hammer,
            ("cooking", "cutting", "pouring", "scooping", "turning"),
        ),
        "spatula": ObjectClass(
            (spatula, solid_turner, fish_turner), any_spatula, ("hammering", "pouring")
        ),
        "bottle": ObjectClass(
            (bottle, wine_bottle, squeeze_bottle),
            any_bottle,
            ("cooking", "cutting", "hammering", "scooping", "turning"),
        ),
        "knife": ObjectClass(
            (knife, lambda: knife(blade_length=0.090, blade_height=0.022, handle_length=0.108,
                                  handle_height=0.020, tip_drop=0.45, belly=0.4)),
            any_knife,
            ("cooking", "hammering", "pouring", "scooping"),
        ),
        "scissors": ObjectClass(
            (scissors, lambda: scissors(blade_length=0.092, blade_width=0.021, shank=0.036,
                                        rings=((0.042, 0.031), (0.074, 0.036)), rod=0.0105,
                                        opening_deg=26)),
            any_scissors,
            ("cooking", "hammering", "pouring", "scooping", "turning"),
        ),
        "mug": ObjectClass(
            (mug, lambda: mug(diameter=0.090, base_share=0.68, height=0.104, reach=0.036)),
            any_mug,
            ("cutting", "hammering", "turning"),
        ),
        "screwdriver": ObjectClass(
            (screwdriver, lambda: screwdriver(shaft_length=0.085, shaft_diameter=0.0055,
                                              handle_length=0.095, handle_diameter=0.029,
                                              cross_tip=True, lobes=5)),
            any_screwdriver,
            ("cooking", "cutting", "pouring", "scooping"),
        ),
        "box": ObjectClass(
            (box, lidded_box), any_box, ("cooking", "cutting", "hammering", "scooping", "turning")
        ),
        "can": ObjectClass(
            (food_can, drinks_can), any_can, ("cutting", "scooping", "turning")
        ),
        "bowl": ObjectClass(
            (bowl, lambda: bowl(diameter=0.240, height=0.098, foot=0.105, wall=0.0018,
                                fullness=0.72, density=STEEL)),
            any_bowl,
            ("cutting", "hammering", "turning"),
        ),
        "spoon": ObjectClass((spoon,), any_spoon, ("hammering",)),
    }
)  # fmt: skip

ALIASES: Mapping[str, str] = MappingProxyType(
    {"saucepan": "pan1", **{class_name: f"{class_name}1" for class_name in CLASSES}}
)
"""Other names: a class alone means its first object; a bundled view calls pan1 a saucepan."""


def _named(builder: Builder, name: str, class_name: str) -> Builder:
    def build_it() -> CatalogueObject:
        return _classified(builder(), name, class_name)

    return build_it


def _classified(thing: CatalogueObject, name: str, class_name: str) -> CatalogueObject:
    return replace(
        thing,
        name=name,
        class_name=class_name,
        not_afforded=CLASSES[class_name].not_afforded,
    )


CATALOGUE: Mapping[str, Builder] = MappingProxyType(
    {
        f"{class_name}{number}": _named(builder, f"{class_name}{number}", class_name)
        for class_name, members in CLASSES.items()
        for number, builder in enumerate(members.builders, start=1)
    }
)


def build(name: str) -> CatalogueObject:
    """Return the object of this name, e.g. pan2; a class alone means its first object.

    Raises
    ------
    ValueError
        No such object; the message lists the known ones.
    """
    known = ALIASES.get(name, name)
    if known not in CATALOGUE:
        raise ValueError(f"no object {name!r} in the catalogue; known are {', '.join(CATALOGUE)}")
    return CATALOGUE[known]()


def variant(class_name: str, rng: np.random.Generator) -> CatalogueObject:
    """Return a random object of this class, in dimensions that belong together.

    Its name is that of the class; the same state of the generator draws the
    same object.

    Raises
    ------
    ValueError
        No such class; the message lists the known ones.
    """
    if class_name not in CLASSES:
        raise ValueError(
            f"no class {class_name!r} in the catalogue; known are {', '.join(CLASSES)}"
        )
    return _classified(CLASSES[class_name].variant(rng), class_name, class_name)
