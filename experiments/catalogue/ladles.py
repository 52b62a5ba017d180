"""Ladles: a deep bowl on a handle that rises."""

from __future__ import annotations

import numpy as np

from experiments.catalogue.draws import around, between
from experiments.catalogue.forms import limb, shell
from experiments.catalogue.model import NYLON, STEEL, CatalogueObject, Mesh, Part
from experiments.catalogue.shapes import revolve, scaled, superellipse, sweep

REGIONS = {"scooping": ("handle",), "handover": ("bowl",)}


def ladle(
    *,
    bowl_diameter: float = 0.090,
    bowl_depth: float = 0.040,
    handle_length: float = 0.270,
    lean_deg: float = 20.0,
    handle_width: float = 0.026,
) -> CatalogueObject:
    """Return a ladle, bowl opening towards +z, handle rising from its rim at +x.

    All lengths in metres; `lean_deg` is how far the handle leans from the vertical.
    """
    radius, wall, stout = bowl_diameter / 2, 0.0018, handle_width / 0.026
    angle = np.linspace(0, np.pi / 2, 12)
    outside = np.column_stack([radius * np.sin(angle), -bowl_depth * np.cos(angle)])
    inside = np.column_stack(
        [(radius - wall) * np.sin(angle), -(bowl_depth - wall) * np.cos(angle)]
    )[::-1]
    bowl = revolve(np.vstack([outside, inside]))
    lean = np.radians(lean_deg)
    start = np.array([radius - 0.004, 0, -0.012])
    direction = np.array([np.sin(lean), 0, np.cos(lean)])
    share = np.array([0.0, 0.06, 0.15, 0.45, 0.55, 0.80, 0.93, 1.0])
    width = np.array([0.024, 0.018, 0.014, 0.014, 0.022, 0.026, 0.026, 0.014]) * stout
    thick = np.array([0.0035, 0.0045, 0.0045, 0.0045, 0.009, 0.010, 0.010, 0.006])
    spine = start + np.outer(handle_length * share, direction)
    sections = [superellipse(w, t, 3) for w, t in zip(width, thick, strict=True)]
    return CatalogueObject(
        "ladle",
        "soup ladle",
        (
            Part("bowl", (bowl,), STEEL),
            Part("handle", (sweep(spine, sections, side=(0, 1, 0)),), STEEL),
        ),
        REGIONS,
    )


def hooked_ladle(
    *,
    bowl_diameter: float = 0.080,
    bowl_depth: float = 0.036,
    handle_length: float = 0.255,
    handle_width: float = 0.017,
    lean_deg: float = 8.0,
    hook: float = 0.016,
) -> CatalogueObject:
    """Return a one-piece steel ladle whose handle ends in a hook, of radius `hook`; metres."""
    radius, wall = bowl_diameter / 2, 0.0018
    lean = np.radians(lean_deg)
    along, back = np.array([np.sin(lean), 0, np.cos(lean)]), np.array([np.cos(lean), 0, 0])
    start = np.array([radius - wall, 0, -0.30 * bowl_depth])
    straight = [start, start + 0.012 * along] + [
        start + share * (handle_length - hook) * along for share in (0.25, 0.5, 0.75, 1.0)
    ]
    turn = np.radians([30, 60, 90, 120, 150, 175])
    bend = [straight[-1] + hook * ((1 - np.cos(a)) * back + np.sin(a) * along) for a in turn]
    w = handle_width
    profile = [
        (0.0, 1.5 * w, 0.0030),
        (0.10, 0.80 * w, 0.0045),
        (0.35, 0.75 * w, 0.0045),
        (0.65, w, 0.0048),
        (0.88, w, 0.0042),
        (1.0, 0.80 * w, 0.0035),
    ]
    handle = limb([*straight, *bend], profile, (0, 1, 0), exponent=3, steps=48, round_end=0.004)
    return CatalogueObject(
        "hooked_ladle",
        "one-piece ladle with a hook",
        (Part("bowl", (_bowl(radius, bowl_depth, wall),), STEEL), Part("handle", (handle,), STEEL)),
        REGIONS,
    )


def serving_ladle(
    *,
    bowl_length: float = 0.110,
    bowl_width: float = 0.084,
    bowl_depth: float = 0.044,
    handle_length: float = 0.230,
    handle_width: float = 0.027,
    lean_deg: float = 52.0,
) -> CatalogueObject:
    """Return a nylon ladle: an oval bowl, a neck, a stout leaning handle; metres."""
    wall = 0.0028
    lean = np.radians(lean_deg)
    start = np.array([bowl_length / 2 - 0.8 * wall, 0, -0.35 * bowl_depth])
    end = handle_length * np.array([np.sin(lean), 0, np.cos(lean)])
    spine = start + np.array([(0, 0, 0), (0.03, 0, 0.10), (0.30, 0, 0.42), (1, 0, 1)]) * end
    w = handle_width
    profile = [
        (0.0, 0.95 * w, 0.007),
        (0.12, 0.55 * w, 0.010),
        (0.40, 0.55 * w, 0.010),
        (0.58, 0.95 * w, 0.015),
        (0.90, w, 0.016),
        (1.0, 0.85 * w, 0.013),
    ]
    handle = limb(spine, profile, (0, 1, 0), round_end=0.011)
    bowl = scaled(_bowl(bowl_length / 2, bowl_depth, wall), (1, bowl_width / bowl_length, 1))
    return CatalogueObject(
        "serving_ladle",
        "nylon ladle with an oval bowl",
        (Part("bowl", (bowl,), NYLON), Part("handle", (handle,), NYLON)),
        REGIONS,
    )


def any_ladle(rng: np.random.Generator) -> CatalogueObject:
    """Return a random ladle; a large bowl comes with a long handle."""
    kind = rng.integers(3)
    size = between(rng, 0.72, 1.18)
    diameter = 0.088 * size
    depth = diameter * between(rng, 0.38, 0.52)
    length = around(rng, 0.265 * size**0.5, 0.07)
    if kind == 0:
        return ladle(
            bowl_diameter=diameter,
            bowl_depth=depth,
            handle_length=length,
            lean_deg=between(rng, 5, 35),
            handle_width=around(rng, 0.025, 0.1),
        )
    if kind == 1:
        return hooked_ladle(
            bowl_diameter=diameter,
            bowl_depth=depth,
            handle_length=length,
            handle_width=around(rng, 0.017, 0.1),
            lean_deg=between(rng, 2, 25),
            hook=between(rng, 0.012, 0.020),
        )
    return serving_ladle(
        bowl_length=1.2 * diameter,
        bowl_width=1.2 * diameter * between(rng, 0.72, 0.95),
        bowl_depth=depth,
        handle_length=length,
        handle_width=around(rng, 0.026, 0.1),
        lean_deg=between(rng, 30, 62),
    )


def _bowl(radius: float, depth: float, wall: float) -> Mesh:
    angle = np.linspace(0, np.pi / 2, 14)
    return revolve(shell(np.column_stack([radius * np.sin(angle), -depth * np.cos(angle)]), wall))
