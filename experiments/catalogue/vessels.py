"""Mugs and bowls: open vessels with real walls."""

from __future__ import annotations

import numpy as np

from experiments.catalogue.draws import around, between
from experiments.catalogue.forms import curve, limb, shell
from experiments.catalogue.model import CERAMIC, STEEL, CatalogueObject, Part
from experiments.catalogue.shapes import revolve


def mug(
    *,
    diameter: float = 0.082,
    base_share: float = 0.94,
    height: float = 0.095,
    wall: float = 0.0042,
    reach: float = 0.034,
    grip: float = 0.012,
    density: float = CERAMIC,
) -> CatalogueObject:
    """Return a mug on z = 0, its handle at +x; metres.

    Parameters
    ----------
    diameter, height, wall : float
        Of the body.
    base_share : float
        Diameter of the base as a share of the rim's.
    reach : float
        How far the handle stands off.
    grip : float
        Width of the handle.
    density : float
        kg/m3.
    """
    radius = diameter / 2
    base = base_share * radius
    outside = np.vstack(
        [
            curve([(0, 0), (base - 0.007, 0)], 4)[:-1],
            curve([(base - 0.007, 0), (base - 0.002, 0.002), (base, 0.008)], 6)[:-1],
            curve([(base, 0.008), ((base + radius) / 2, 0.5 * height), (radius, height)], 10),
        ]
    )
    body = revolve(shell(outside, wall))

    def side(share: float) -> float:
        return base + (radius - base) * share - wall / 2

    knots = [
        (side(0.83), 0, 0.83 * height),
        (side(0.83) + 0.35 * reach, 0, 0.855 * height),
        (radius + 0.86 * reach, 0, 0.76 * height),
        (radius + reach, 0, 0.56 * height),
        (radius + 0.78 * reach, 0, 0.33 * height),
        (side(0.2) + 0.35 * reach, 0, 0.20 * height),
        (side(0.2), 0, 0.19 * height),
    ]
    profile = [(0, 1.2 * grip, 0.8 * grip), (0.2, grip, 0.62 * grip), (0.8, grip, 0.62 * grip),
               (1, 1.1 * grip, 0.75 * grip)]  # fmt: skip
    handle = limb(knots, profile, (0, 1, 0), exponent=2.4, steps=44)
    return CatalogueObject(
        "mug",
        "mug with a handle",
        (Part("body", (body,), density), Part("handle", (handle,), density)),
        {"pouring": ("handle",), "handover": ("body",)},
    )


def bowl(
    *,
    diameter: float = 0.155,
    height: float = 0.066,
    foot: float = 0.070,
    wall: float = 0.0042,
    fullness: float = 0.62,
    density: float = CERAMIC,
) -> CatalogueObject:
    """Return a bowl with a foot ring, on z = 0; metres.

    Parameters
    ----------
    diameter, height, wall : float
        Of the bowl.
    foot : float
        Diameter of the foot.
    fullness : float
        Height at which it has half of its flare left to go, 0.5 for a straight
        cone, more for a rounder bowl.
    density : float
        kg/m3.
    """
    radius, stand, lift = diameter / 2, foot / 2, 0.004
    half = stand + fullness * (radius - stand)
    outside = np.vstack(
        [
            curve([(0, lift), (0.9 * stand, lift)], 4)[:-1],
            curve(
                [
                    (0.9 * stand, lift),
                    (stand + 0.25 * fullness * (radius - stand), lift + 0.05 * height),
                    (half, lift + 0.26 * height),
                    (stand + (0.5 + 0.5 * fullness) * (radius - stand), lift + 0.55 * height),
                    (radius, height),
                ],
                20,
            ),
        ]
    )
    base = revolve(
        [(0, 0), (0.92 * stand, 0), (0.95 * stand, lift + wall / 3), (0, lift + wall / 3)]
    )
    return CatalogueObject(
        "bowl",
        f"{'mixing' if diameter > 0.2 else 'cereal'} bowl",
        (Part("bowl", (revolve(shell(outside, wall)), base), density),),
        {"handover": ("bowl",)},
    )


def any_mug(rng: np.random.Generator) -> CatalogueObject:
    """Return a random mug of 0.2 to 0.5 litres; two fingers or more fit into its handle."""
    diameter = between(rng, 0.072, 0.096)
    return mug(
        diameter=diameter,
        base_share=between(rng, 0.68, 1.0),
        height=diameter * between(rng, 0.95, 1.35),
        wall=around(rng, 0.0040, 0.12),
        reach=between(rng, 0.027, 0.041),
        grip=around(rng, 0.012, 0.12),
    )


def any_bowl(rng: np.random.Generator) -> CatalogueObject:
    """Return a random bowl, from a dip bowl to a mixing bowl of steel."""
    diameter = between(rng, 0.110, 0.260)
    steel = diameter > 0.20
    return bowl(
        diameter=diameter,
        height=diameter * between(rng, 0.34, 0.50),
        foot=diameter * between(rng, 0.36, 0.52),
        wall=around(rng, 0.0018, 0.1) if steel else around(rng, 0.0042, 0.12),
        fullness=between(rng, 0.55, 0.80),
        density=STEEL if steel else CERAMIC,
    )
