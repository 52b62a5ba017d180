"""Pans: an open vessel with one long handle."""

from __future__ import annotations

import numpy as np

from experiments.catalogue.draws import around, between
from experiments.catalogue.forms import curve, limb, ring, shell
from experiments.catalogue.model import ALUMINIUM, NYLON, STEEL, CatalogueObject, Mesh, Part
from experiments.catalogue.shapes import revolve, superellipse, sweep

REGIONS = {"cooking": ("handle",), "handover": ("pot",)}


def saucepan(
    *,
    diameter: float = 0.180,
    height: float = 0.095,
    wall: float = 0.0025,
    handle_length: float = 0.185,
    handle_width: float = 0.025,
    handle_rise: float = 0.020,
) -> CatalogueObject:
    """Return a saucepan standing on z = 0, its handle along +x; all lengths in metres."""
    radius, stout = diameter / 2, handle_width / 0.025
    pot = revolve(
        [
            (0, 0),
            (0.86 * radius, 0),
            (0.95 * radius, 0.004),
            (0.99 * radius, 0.014),
            (radius, 0.92 * height),
            (radius + 0.003, 0.97 * height),
            (radius + 0.003, height),
            (radius - wall, height),
            (radius - wall, 0.92 * height),
            (0.99 * radius - wall, 0.014),
            (0.95 * radius - wall, 0.006),
            (0.86 * radius - wall, wall),
            (0, wall),
        ]
    )
    share = np.array([0.0, 0.08, 0.18, 0.30, 0.50, 0.70, 0.88, 0.96, 1.0])
    width = np.array([0.020, 0.018, 0.018, 0.021, 0.024, 0.025, 0.025, 0.021, 0.012]) * stout
    thick = np.array([0.012, 0.012, 0.014, 0.017, 0.019, 0.019, 0.018, 0.015, 0.008]) * stout
    spine = np.column_stack(
        [
            radius - 0.004 + handle_length * share,
            np.zeros_like(share),
            0.80 * height + handle_rise * np.sin(share * np.pi / 2),
        ]
    )
    sections = [superellipse(w, t, 2.4) for w, t in zip(width, thick, strict=True)]
    return CatalogueObject(
        "saucepan",
        "saucepan with a long handle",
        (
            Part("pot", (pot,), STEEL),
            Part("handle", (sweep(spine, sections, side=(0, 1, 0)),), NYLON),
        ),
        REGIONS,
    )


def frying_pan(
    *,
    diameter: float = 0.280,
    base_diameter: float = 0.205,
    height: float = 0.050,
    wall: float = 0.0035,
    handle_length: float = 0.195,
    handle_width: float = 0.030,
    handle_rise: float = 0.050,
) -> CatalogueObject:
    """Return a coated frying pan with flared walls, on z = 0, its handle along +x; metres."""
    radius = diameter / 2
    start = np.array([radius - wall / 2, 0, 0.82 * height])
    spine = start + np.array([handle_length, 1.0, handle_rise]) * [
        (0.0, 0, 0.0),
        (0.12, 0, 0.06),
        (0.35, 0, 0.45),
        (0.70, 0, 0.88),
        (1.0, 0, 1.0),
    ]
    w = handle_width
    profile = [
        (0.0, 0.95 * w, 0.008),
        (0.08, 0.75 * w, 0.010),
        (0.28, 0.72 * w, 0.013),
        (0.60, w, 0.018),
        (0.85, 0.98 * w, 0.017),
        (1.0, 0.85 * w, 0.013),
    ]
    handle = limb(spine, profile, (0, 1, 0), round_end=0.012)
    return CatalogueObject(
        "frying_pan",
        "frying pan with flared walls",
        (
            Part("pot", (_flared(radius, base_diameter / 2, height, wall),), ALUMINIUM),
            Part("handle", (handle,), NYLON),
        ),
        REGIONS,
    )


def skillet(
    *,
    diameter: float = 0.260,
    base_diameter: float = 0.225,
    height: float = 0.048,
    wall: float = 0.0045,
    handle_length: float = 0.135,
    handle_width: float = 0.027,
) -> CatalogueObject:
    """Return a cast-iron skillet: a short handle with an eye to hang it by; metres."""
    radius, w = diameter / 2, handle_width
    level = 0.80 * height
    eye = 0.62 * w
    stem = handle_length - 1.6 * eye
    spine = [
        (radius - wall / 2, 0, level),
        (radius + 0.3 * stem, 0, level + 0.004),
        (radius + stem, 0, level + 0.012),
    ]
    profile = [(0, 1.25 * w, 0.011), (0.15, 0.9 * w, 0.011), (0.6, w, 0.013), (1, 1.1 * w, 0.012)]
    loop = ring(
        (radius + stem + 0.62 * eye, 0, level + 0.0125),
        (0.95 * eye, 0.78 * eye),
        (0.012, 0.46 * w),
    )
    return CatalogueObject(
        "skillet",
        "cast-iron skillet with a short handle",
        (
            Part("pot", (_flared(radius, base_diameter / 2, height, wall),), 7200.0),
            Part("handle", (limb(spine, profile, (0, 1, 0)), loop), 7200.0),
        ),
        REGIONS,
    )


def any_pan(rng: np.random.Generator) -> CatalogueObject:
    """Return a random pan, 14 to 32 cm wide; a wide one is flatter and has a longer handle."""
    kind = rng.integers(3)
    diameter = between(rng, 0.14, 0.24) if kind == 0 else between(rng, 0.20, 0.32)
    size = diameter / 0.24
    width = around(rng, 0.027, 0.08)
    if kind == 0:
        return saucepan(
            diameter=diameter,
            height=diameter * between(rng, 0.42, 0.68),
            wall=around(rng, 0.0025, 0.2),
            handle_length=around(rng, 0.19 * size**0.4, 0.08),
            handle_width=width,
            handle_rise=between(rng, 0.0, 0.04),
        )
    if kind == 1:
        return frying_pan(
            diameter=diameter,
            base_diameter=diameter * between(rng, 0.66, 0.82),
            height=around(rng, 0.048 * size**0.5, 0.12),
            wall=around(rng, 0.0035, 0.15),
            handle_length=around(rng, 0.19 * size**0.4, 0.08),
            handle_width=width,
            handle_rise=between(rng, 0.02, 0.07),
        )
    return skillet(
        diameter=diameter,
        base_diameter=diameter * between(rng, 0.80, 0.90),
        height=around(rng, 0.048 * size**0.4, 0.08),
        handle_length=around(rng, 0.135 * size**0.5, 0.08),
        handle_width=width,
    )


def _flared(radius: float, base: float, height: float, wall: float) -> Mesh:
    """Return an open vessel whose walls lean outwards."""
    knots = [
        (0, 0),
        (0.96 * base, 0),
        (base + 0.10 * (radius - base), 0.05 * height),
        (base + 0.45 * (radius - base), 0.36 * height),
        (radius, height),
    ]
    flat, wall_part = curve(knots[:2], 4), curve(knots[1:], 16)
    return revolve(shell(np.vstack([flat[:-1], wall_part]), wall))
