"""Scissors: two blades about a pivot, two rings for the fingers."""

from __future__ import annotations

import numpy as np

from experiments.catalogue.draws import around, between
from experiments.catalogue.forms import limb, ring
from experiments.catalogue.model import NYLON, STEEL, CatalogueObject, Mesh, Part
from experiments.catalogue.shapes import moved, revolve, superellipse, sweep

Array = np.ndarray[tuple[int, ...], np.dtype[np.float64]]


def scissors(
    *,
    blade_length: float = 0.104,
    blade_width: float = 0.018,
    shank: float = 0.040,
    rings: tuple[tuple[float, float], tuple[float, float]] = ((0.060, 0.034), (0.060, 0.034)),
    rod: float = 0.010,
    opening_deg: float = 18.0,
) -> CatalogueObject:
    """Return scissors in the x-y plane, pivot at the origin, tips towards +x; metres.

    Parameters
    ----------
    blade_length : float
        From the pivot to the tip.
    blade_width : float
        At its widest, near the pivot.
    shank : float
        From the pivot to where the rings begin.
    rings : tuple
        Inner length and width of the two finger rings.
    rod : float
        Thickness of the rings.
    opening_deg : float
        Angle between the blades.
    """
    blades, grips = [], []
    for sign, (inner_length, inner_width) in zip((-1.0, 1.0), rings, strict=True):
        half = sign * np.radians(opening_deg) / 2
        turn = np.array(
            [[np.cos(half), -np.sin(half), 0], [np.sin(half), np.cos(half), 0], [0, 0, 1]]
        )
        blades.append(moved(_blade(blade_length, blade_width, sign), (0, 0, 0), turn))
        radii = (inner_length / 2 + rod / 2, inner_width / 2 + rod / 2)
        middle = np.array([-shank - radii[0] + rod, -sign * (radii[1] + 0.004), 0.0])
        joint = middle + np.array([0.85 * radii[0], sign * 0.45 * radii[1], 0])
        level = -sign * 0.0014
        stem = limb(
            [(-0.004, 0, level), (-0.45 * shank, -sign * 0.004, 0.6 * level), joint],
            [(0, 0.85 * blade_width, 0.004), (0.4, 0.8 * rod + 0.003, 0.8 * rod), (1, rod, rod)],
            (0, 1, 0),
            exponent=2.8,
        )
        loop = ring(middle, radii, (rod, rod))
        grips += [moved(mesh, (0, 0, 0), turn) for mesh in (stem, loop)]
    pivot = revolve([(0, -0.0038), (0.0036, -0.0038), (0.0042, -0.0030), (0.0042, 0.0030),
                     (0.0036, 0.0038), (0, 0.0038)], 32)  # fmt: skip
    return CatalogueObject(
        "scissors",
        "household scissors",
        (Part("blades", (*blades, pivot), STEEL), Part("handles", tuple(grips), NYLON)),
        {"cutting": ("handles",), "handover": ("blades",)},
    )


def any_scissors(rng: np.random.Generator) -> CatalogueObject:
    """Return random scissors: the rings fit fingers, the blades may be short or long."""
    blade = between(rng, 0.065, 0.125)
    small = around(rng, 0.044, 0.12)
    large = small * between(rng, 1.0, 1.7)
    width = around(rng, 0.031, 0.08)
    return scissors(
        blade_length=blade,
        blade_width=around(rng, 0.017 * (blade / 0.10) ** 0.5, 0.1),
        shank=around(rng, 0.034, 0.12),
        rings=((small, width), (large, width * between(rng, 0.95, 1.15))),
        rod=around(rng, 0.0095, 0.1),
        opening_deg=between(rng, 6, 35),
    )


def _blade(length: float, width: float, sign: float) -> Mesh:
    """Return one blade, its cutting edge straight, its back curved towards the tip."""
    share = np.array([0.0, 0.08, 0.2, 0.4, 0.6, 0.75, 0.88, 0.96, 1.0])
    wide = np.array([0.90, 1.0, 1.0, 0.90, 0.74, 0.57, 0.36, 0.19, 0.08]) * width
    along = -0.012 + (length + 0.012) * share
    level = np.full_like(along, -sign * 0.0014)
    spine = np.column_stack([along, sign * (width / 2 - wide / 2), level])
    return sweep(spine, [superellipse(w, 0.0026, 4) for w in wide], side=(0, -1, 0))
