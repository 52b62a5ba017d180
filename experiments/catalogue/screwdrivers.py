"""Screwdrivers: a lobed grip and a steel shaft."""

from __future__ import annotations

import numpy as np

from experiments.catalogue.draws import around, between
from experiments.catalogue.forms import curve, limb
from experiments.catalogue.model import NYLON, STEEL, CatalogueObject, Part
from experiments.catalogue.shapes import sweep


def screwdriver(
    *,
    shaft_length: float = 0.110,
    shaft_diameter: float = 0.0065,
    handle_length: float = 0.105,
    handle_diameter: float = 0.033,
    cross_tip: bool = False,
    lobes: int = 6,
) -> CatalogueObject:
    """Return a screwdriver along x, its tip towards +x, the collar at the origin; metres.

    `cross_tip` gives it a cone for cross-head screws instead of a flat blade.
    """
    d = shaft_diameter
    tip = (
        [(0, d, d), (0.93, d, d), (0.985, 0.45 * d, 0.45 * d), (1, 0.30 * d, 0.30 * d)]
        if cross_tip
        else [(0, d, d), (0.86, d, d), (0.91, 1.18 * d, 0.6 * d), (1, 1.1 * d, 0.14 * d)]
    )
    shaft = limb(
        [(-0.02, 0, 0), (shaft_length, 0, 0)], tip, (0, 1, 0), exponent=2.2, steps=60, segments=20
    )
    outline = curve(
        [
            (0.0, 0.42),
            (0.03, 0.50),
            (0.12, 0.50),
            (0.22, 0.42),
            (0.36, 0.46),
            (0.60, 0.50),
            (0.86, 0.49),
            (0.96, 0.40),
            (1.0, 0.22),
        ],
        40,
    )
    angle = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    depth = 0.07 * np.clip((outline[:, 0] - 0.26) / 0.1, 0, 1)
    wave = 1 + depth[:, None] * (np.cos(lobes * angle) - 1) / 2
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    sections = [
        handle_diameter * radius * ripple[:, None] * circle
        for (_, radius), ripple in zip(outline, wave, strict=True)
    ]
    spine = np.column_stack([-handle_length * outline[:, 0], 0 * angle[:40], 0 * angle[:40]])
    return CatalogueObject(
        "screwdriver",
        "cross-head screwdriver" if cross_tip else "flat-blade screwdriver",
        (
            Part("shaft", (shaft,), STEEL),
            Part("handle", (sweep(spine, sections, side=(0, 1, 0)),), NYLON),
        ),
        {"handover": ("shaft",)},
    )


def any_screwdriver(rng: np.random.Generator) -> CatalogueObject:
    """Return a random screwdriver: thick shafts have thick grips and are longer."""
    diameter = between(rng, 0.0040, 0.0085)
    size = diameter / 0.0065
    return screwdriver(
        shaft_length=around(rng, 0.110 * size**0.5, 0.20),
        shaft_diameter=diameter,
        handle_length=around(rng, 0.102 * size**0.3, 0.05),
        handle_diameter=around(rng, 0.032 * size**0.4, 0.05),
        cross_tip=bool(rng.integers(2)),
        lobes=int(rng.integers(4, 8)),
    )
