"""Groceries without a handle: cartons and cans."""

from __future__ import annotations

import numpy as np

from experiments.catalogue.draws import around, between
from experiments.catalogue.forms import curve, rounded_box
from experiments.catalogue.model import WATER, CatalogueObject, Part
from experiments.catalogue.shapes import moved, revolve

CEREAL, DRY_FOOD, CARDBOARD_BOX = 160.0, 300.0, 250.0
"""Densities of what is bought in a carton, carton included, kg/m3."""


def box(
    *,
    width: float = 0.190,
    depth: float = 0.062,
    height: float = 0.285,
    edge: float = 0.0025,
    density: float = CEREAL,
) -> CatalogueObject:
    """Return a closed carton standing on z = 0; metres."""
    return CatalogueObject(
        "box",
        "cereal box" if height > 0.2 else "carton",
        (Part("carton", (rounded_box((width, depth, height), edge),), density),),
        {"handover": ("carton",)},
    )


def lidded_box(
    *,
    width: float = 0.170,
    depth: float = 0.120,
    height: float = 0.085,
    lid_height: float = 0.030,
    edge: float = 0.003,
) -> CatalogueObject:
    """Return a filled cardboard box whose lid overlaps it, on z = 0; metres."""
    lid = moved(
        rounded_box((width + 0.005, depth + 0.005, lid_height), edge),
        (0, 0, height + 0.002 - lid_height),
    )
    return CatalogueObject(
        "lidded_box",
        "cardboard box with a lid",
        (
            Part("box", (rounded_box((width, depth, height), edge),), CARDBOARD_BOX),
            Part("lid", (lid,), CARDBOARD_BOX),
        ),
        {"handover": ("box", "lid")},
    )


def food_can(
    *, diameter: float = 0.073, height: float = 0.109, rim: float = 0.0022, ribs: int = 9
) -> CatalogueObject:
    """Return a full food can: seams at both ends, ribs about its middle, on z = 0; metres."""
    radius = diameter / 2 - rim
    wave = np.linspace(0, 1, 8 * ribs + 1)
    ribbed = np.column_stack(
        [
            radius - 0.0009 * np.sin(np.pi * ribs * wave) ** 2,
            height * (0.22 + 0.56 * wave),
        ]
    )
    profile = [
        (0, 0.003),
        (radius - 0.003, 0.003),
        (radius - 0.001, 0.0),
        (radius + 0.7 * rim, 0.0),
        (radius + rim, 0.0008),
        (radius + rim, 0.0032),
        (radius, 0.0045),
        *ribbed,
        (radius, height - 0.0045),
        (radius + rim, height - 0.0032),
        (radius + rim, height - 0.0008),
        (radius + 0.7 * rim, height),
        (radius - 0.001, height),
        (radius - 0.003, height - 0.003),
        (0, height - 0.003),
    ]
    return CatalogueObject(
        "food_can",
        "food can",
        (Part("can", (revolve(profile),), 1.05 * WATER),),
        {"handover": ("can",)},
    )


def drinks_can(*, diameter: float = 0.066, height: float = 0.115) -> CatalogueObject:
    """Return a full drinks can, drawn in at top and bottom, on z = 0; metres."""
    radius, lid = diameter / 2, 0.41 * diameter
    profile = np.vstack(
        [
            curve([(0, 0.009), (0.25 * diameter, 0.0065), (0.345 * diameter, 0.0012)], 8),
            curve([(0.36 * diameter, 0), (0.40 * diameter, 0.001), (radius, 0.013)], 8),
            curve([(radius, height - 0.020), (0.47 * diameter, height - 0.011),
                   (lid - 0.0015, height - 0.004)], 8),
            [(lid, height - 0.0025), (lid, height - 0.0006), (lid - 0.0012, height),
             (lid - 0.0022, height - 0.0006), (lid - 0.0030, height - 0.0055),
             (lid - 0.0060, height - 0.0045), (0, height - 0.0045)],
        ]
    )  # fmt: skip
    return CatalogueObject(
        "drinks_can",
        "drinks can",
        (Part("can", (revolve(profile),), WATER),),
        {"handover": ("can",)},
    )


def any_box(rng: np.random.Generator) -> CatalogueObject:
    """Return a random carton, from a tea packet to a cereal box."""
    if rng.integers(3) == 0:
        width = between(rng, 0.10, 0.21)
        height = between(rng, 0.05, 0.11)
        return lidded_box(
            width=width,
            depth=width * between(rng, 0.55, 0.95),
            height=height,
            lid_height=height * between(rng, 0.25, 0.5),
        )
    height = between(rng, 0.09, 0.30)
    tall = height > 0.18
    width = height * between(rng, 0.55, 0.80)
    return box(
        width=width,
        depth=width * (between(rng, 0.28, 0.42) if tall else between(rng, 0.30, 0.70)),
        height=height,
        edge=between(rng, 0.0015, 0.004),
        density=around(rng, CEREAL if tall else DRY_FOOD, 0.2),
    )


def any_can(rng: np.random.Generator) -> CatalogueObject:
    """Return a random can, from tuna to tomatoes, or one to drink from."""
    if rng.integers(2):
        diameter = between(rng, 0.053, 0.068)
        return drinks_can(diameter=diameter, height=diameter * between(rng, 1.65, 2.5))
    diameter = between(rng, 0.060, 0.100)
    height = diameter * between(rng, 0.55, 1.6)
    return food_can(diameter=diameter, height=height, ribs=max(3, round(height / 0.0075 * 0.56)))
