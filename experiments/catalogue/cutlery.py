"""Knives and spoons."""

from __future__ import annotations

import numpy as np

from experiments.catalogue.draws import around, between
from experiments.catalogue.forms import curve, limb, shell
from experiments.catalogue.model import NYLON, STEEL, CatalogueObject, Part
from experiments.catalogue.shapes import loft, revolve, scaled


def knife(
    *,
    blade_length: float = 0.200,
    blade_height: float = 0.045,
    handle_length: float = 0.125,
    handle_height: float = 0.026,
    tip_drop: float = 0.55,
    belly: float = 0.50,
) -> CatalogueObject:
    """Return a knife in the x-z plane, tip towards +x, edge down; lengths in metres.

    Parameters
    ----------
    blade_length, blade_height, handle_length, handle_height : float
        Metres.
    tip_drop : float
        How far below the back the tip is, as a share of the blade's height.
    belly : float
        Where along the blade the edge begins to rise, as a share of its length.
    """
    h = blade_height
    edge = curve(
        [(0, -h), (belly, -0.985 * h), (0.86, -(tip_drop + 0.62 * (1 - tip_drop)) * h),
         (0.965, -(tip_drop + 0.22 * (1 - tip_drop)) * h), (1.0, -(tip_drop + 0.04) * h)],
        40,
    )  # fmt: skip
    back = curve([(0, 0), (0.45, -0.01 * h), (0.8, -0.28 * tip_drop * h), (1.0, -tip_drop * h)], 40)
    share = np.concatenate([np.linspace(0, 0.8, 12), np.linspace(0.84, 1.0, 8)])
    low, top = (np.interp(share, line[:, 0], line[:, 1]) for line in (edge, back))
    thick = np.interp(share, [0, 0.7, 1], [0.0025, 0.0020, 0.0009])
    rings = [
        np.array([[x, -t / 2, b], [x, t / 2, b], [x, t / 20, e], [x, -t / 20, e]])[::-1]
        for x, b, e, t in zip(blade_length * share, top, low, thick, strict=True)
    ]
    g = handle_height
    spine = np.array([(0.006, -0.50), (0.75, -0.46), (0.45, -0.40), (0.15, -0.52), (0.0, -0.66)])
    spine[0, 0] = 1 + 0.006 / handle_length
    knots = [((s - 1) * handle_length, 0, z * g) for s, z in spine]
    handle = limb(
        knots,
        [
            (0.0, 0.60 * g, 0.92 * g),
            (0.10, 0.66 * g, 0.98 * g),
            (0.40, 0.70 * g, 0.92 * g),
            (0.75, 0.70 * g, 1.02 * g),
            (0.92, 0.70 * g, 1.12 * g),
            (1.0, 0.60 * g, 0.95 * g),
        ],
        (0, -1, 0),
        exponent=2.8,
        round_end=0.007,
    )
    return CatalogueObject(
        "knife",
        "chef's knife" if blade_length > 0.15 else "paring knife",
        (Part("blade", (loft(rings),), STEEL), Part("handle", (handle,), NYLON)),
        {"cutting": ("handle",), "handover": ("blade",)},
    )


def spoon(
    *,
    bowl_length: float = 0.066,
    bowl_width: float = 0.044,
    bowl_depth: float = 0.011,
    handle_length: float = 0.140,
    handle_width: float = 0.019,
) -> CatalogueObject:
    """Return a table spoon, bowl opening towards +z, handle along -x; lengths in metres."""
    angle = np.linspace(0, np.pi / 2, 12)
    outside = np.column_stack([bowl_length / 2 * np.sin(angle), -bowl_depth * np.cos(angle)])
    bowl = scaled(revolve(shell(outside, 0.0015)), (1, bowl_width / bowl_length, 1))
    w = handle_width
    knots = [(0.0, -0.003), (0.06, 0.0), (0.18, 0.006), (0.40, 0.014), (0.65, 0.014), (1.0, 0.002)]
    handle = limb(
        [(0.003 - bowl_length / 2 - handle_length * s, 0, z) for s, z in knots],
        [
            (0.0, 0.85 * w, 0.0016),
            (0.07, 0.42 * w, 0.0032),
            (0.18, 0.34 * w, 0.0036),
            (0.40, 0.42 * w, 0.0030),
            (0.65, 0.68 * w, 0.0025),
            (0.88, w, 0.0022),
            (1.0, 0.95 * w, 0.0020),
        ],
        (0, -1, 0),
        exponent=3,
        steps=36,
        round_end=0.008,
    )
    return CatalogueObject(
        "spoon",
        "table spoon",
        (Part("bowl", (bowl,), STEEL), Part("handle", (handle,), STEEL)),
        {"scooping": ("handle",), "handover": ("bowl",)},
    )


def any_knife(rng: np.random.Generator) -> CatalogueObject:
    """Return a random kitchen knife: long blades are tall and have larger handles."""
    length = between(rng, 0.085, 0.240)
    size = length / 0.200
    return knife(
        blade_length=length,
        blade_height=around(rng, 0.042 * size**0.75, 0.10),
        handle_length=around(rng, 0.125 * size**0.2, 0.05),
        handle_height=around(rng, 0.026 * size**0.25, 0.07),
        tip_drop=between(rng, 0.15, 0.75),
        belly=between(rng, 0.3, 0.6),
    )


def any_spoon(rng: np.random.Generator) -> CatalogueObject:
    """Return a random spoon, from a dessert spoon to a serving spoon."""
    size = between(rng, 0.85, 1.45)
    length = around(rng, 0.064 * size, 0.05)
    return spoon(
        bowl_length=length,
        bowl_width=length * between(rng, 0.60, 0.75),
        bowl_depth=around(rng, 0.011 * size, 0.15),
        handle_length=around(rng, 0.138 * size, 0.06),
        handle_width=around(rng, 0.019 * size**0.7, 0.08),
    )
