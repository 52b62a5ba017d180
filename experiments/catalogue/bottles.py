"""Bottles: body, shoulder, neck and cap of one turned profile."""

from __future__ import annotations

import numpy as np

from experiments.catalogue.draws import around, between
from experiments.catalogue.forms import limb
from experiments.catalogue.model import WATER, CatalogueObject, Mesh, Part
from experiments.catalogue.shapes import revolve

REGIONS = {"pouring": ("body", "shoulder"), "handover": ("neck", "cap")}
FULL_GLASS = 1250.0
"""Density of a wine bottle with its wine, kg/m3."""


def bottle(
    *,
    diameter: float = 0.066,
    body_height: float = 0.145,
    shoulder_height: float = 0.038,
    neck_diameter: float = 0.028,
    neck_height: float = 0.022,
    cap_height: float = 0.020,
) -> CatalogueObject:
    """Return a full half-litre bottle standing on z = 0; all lengths in metres."""
    body, neck = diameter / 2, neck_diameter / 2
    top = body_height + shoulder_height
    turn = np.linspace(0, np.pi, 12)
    shoulder = np.column_stack(
        [
            neck + (body - neck) * (1 + np.cos(turn)) / 2,
            body_height + shoulder_height * turn / np.pi,
        ]
    )
    waist = body - 0.0015
    parts = (
        Part(
            "body",
            (
                revolve(
                    [
                        (0, 0.004),
                        (0.6 * body, 0),
                        (0.9 * body, 0.001),
                        (body, 0.006),
                        (body, 0.3 * body_height),
                        (waist, 0.32 * body_height),
                        (waist, 0.78 * body_height),
                        (body, 0.8 * body_height),
                        (body, body_height),
                        (0, body_height),
                    ]
                ),
            ),
            WATER,
        ),
        Part("shoulder", (revolve([(0, body_height), *shoulder, (0, top)]),), WATER),
        Part("neck", (revolve(_cylinder(neck, top - 0.001, top + neck_height)),), WATER),
        Part(
            "cap",
            (
                revolve(
                    _cylinder(neck + 0.0035, top + 0.25 * neck_height, top + 0.4 * neck_height)
                ),
                revolve(
                    _cylinder(
                        neck + 0.002, top + neck_height - 0.002, top + neck_height + cap_height
                    )
                ),
            ),
            WATER,
        ),
    )
    return CatalogueObject(
        "bottle",
        "bottle with a screw cap",
        parts,
        REGIONS,
    )


def wine_bottle(
    *,
    diameter: float = 0.075,
    body_height: float = 0.190,
    shoulder_height: float = 0.045,
    neck_diameter: float = 0.029,
    neck_height: float = 0.045,
    cap_height: float = 0.040,
) -> CatalogueObject:
    """Return a full wine bottle with a long neck under a foil capsule, on z = 0; metres."""
    body, neck = diameter / 2, neck_diameter / 2
    top = body_height + shoulder_height
    turn = np.linspace(0, np.pi, 14)
    shoulder = np.column_stack(
        [
            neck + (body - neck) * ((1 + np.cos(turn)) / 2) ** 0.8,
            body_height + shoulder_height * turn / np.pi,
        ]
    )
    rim = top + neck_height + cap_height
    parts = (
        Part(
            "body",
            (
                revolve(
                    [
                        (0, 0.012),
                        (0.45 * body, 0.006),
                        (0.8 * body, 0.0),
                        (0.96 * body, 0.002),
                        (body, 0.008),
                        (body, body_height),
                        (0, body_height),
                    ]
                ),
            ),
            FULL_GLASS,
        ),
        Part("shoulder", (revolve([(0, body_height), *shoulder, (0, top)]),), FULL_GLASS),
        Part("neck", (revolve(_cylinder(neck, top - 0.001, rim - cap_height)),), FULL_GLASS),
        Part(
            "cap",
            (
                revolve(_cylinder(neck + 0.0006, rim - cap_height - 0.001, rim)),
                revolve(_cylinder(neck + 0.0022, rim - 0.013, rim - 0.006)),
            ),
            FULL_GLASS,
        ),
    )
    return CatalogueObject("wine_bottle", "wine bottle", parts, REGIONS)


def squeeze_bottle(
    *,
    width: float = 0.092,
    depth: float = 0.058,
    body_height: float = 0.150,
    shoulder_height: float = 0.030,
    neck_diameter: float = 0.030,
    cap_height: float = 0.032,
) -> CatalogueObject:
    """Return a full squeeze bottle, oval, with a tapered spout, on z = 0; metres."""
    top = body_height + shoulder_height
    waist, neck = 0.93, neck_diameter
    body = _oval(
        0,
        body_height,
        [
            (0.0, 0.96 * width, 0.95 * depth),
            (0.15, width, depth),
            (0.45, waist * width, 0.95 * depth),
            (0.85, 0.98 * width, 0.98 * depth),
            (1.0, 0.92 * width, 0.95 * depth),
        ],
        exponent=2.3,
        round_start=0.007,
    )
    shoulder = _oval(
        body_height,
        top,
        [
            (0.0, 0.92 * width, 0.95 * depth),
            (0.35, 0.78 * width, 0.86 * depth),
            (0.8, 1.2 * neck, 1.15 * neck),
            (1.0, neck, neck),
        ],
        exponent=2.3,
    )
    lip = top + 0.010
    spout = revolve(
        [
            (0, lip - 0.002),
            (0.66 * neck, lip - 0.002),
            (0.68 * neck, lip),
            (0.66 * neck, lip + 0.35 * cap_height),
            (0.46 * neck, lip + 0.45 * cap_height),
            (0.22 * neck, lip + 0.92 * cap_height),
            (0.18 * neck, lip + 0.98 * cap_height),
            (0, lip + cap_height),
        ]
    )
    parts = (
        Part("body", (body,), WATER),
        Part("shoulder", (shoulder,), WATER),
        Part("neck", (revolve(_cylinder(neck / 2, top - 0.001, lip)),), WATER),
        Part("cap", (spout,), WATER),
    )
    return CatalogueObject("squeeze_bottle", "oval squeeze bottle", parts, REGIONS)


def sauce_bottle(
    *,
    width: float = 0.085,
    depth: float = 0.056,
    body_height: float = 0.130,
    shoulder_height: float = 0.025,
    waist: float = 0.9,
    exponent: float = 2.4,
    cap_diameter: float = 0.036,
    cap_height: float = 0.022,
    cap_taper: float = 0.9,
    nozzle_diameter: float = 0.018,
    nozzle_height: float = 0.018,
) -> CatalogueObject:
    """Return a full bottle whose shoulders slope up to a cap as wide as they end, on z = 0.

    All lengths in metres; `waist` and `cap_taper` are shares of the width and of the cap's
    diameter, `exponent` rounds the cross-section as in `limb`. Without a nozzle (height 0) the
    cap is a flip top.
    """
    top = body_height + shoulder_height
    over = 1.05  # shoulders are round: halfway up they are wider than halfway between their ends

    def halfway(size: float) -> float:
        return max(cap_diameter, over * (size + cap_diameter) / 2)

    body = _oval(
        0,
        body_height,
        [
            (0.0, 0.96 * width, 0.96 * depth),
            (0.12, width, depth),
            (0.45, waist * width, (waist + 1) / 2 * depth),
            (0.85, 0.98 * width, 0.98 * depth),
            (1.0, 0.90 * width, 0.93 * depth),
        ],
        exponent=exponent,
        round_start=0.006,
    )
    shoulder = _oval(
        body_height,
        top,
        [
            (0.0, 0.90 * width, 0.93 * depth),
            (0.5, halfway(0.90 * width), halfway(0.93 * depth)),
            (1.0, cap_diameter, cap_diameter),
        ],
        exponent=exponent,
    )
    radius, high = cap_diameter / 2, top + cap_height
    profile = [
        (0, top - 0.001),
        (radius, top - 0.001),
        (radius * (1 + 3 * cap_taper) / 4, top + 0.8 * cap_height),
        (radius * cap_taper - 0.001, high),
    ]
    if nozzle_height > 0:
        nozzle, tip = nozzle_diameter / 2, high + nozzle_height
        profile += [
            (nozzle, high + 0.0005),
            (0.8 * nozzle, tip - 0.001),
            (0.7 * nozzle, tip),
            (0, tip),
        ]
    else:
        profile += [(0, high)]
    parts = (
        Part("body", (body,), WATER),
        Part("shoulder", (shoulder,), WATER),
        Part("cap", (revolve(profile),), WATER),
    )
    regions = {"pouring": ("body", "shoulder"), "handover": ("cap",)}
    return CatalogueObject("sauce_bottle", "sauce bottle without a neck", parts, regions)


def any_sauce_bottle(rng: np.random.Generator) -> CatalogueObject:
    """Return a random bottle without a neck, oval or round, with a nozzle or a flip top."""
    size = between(rng, 0.75, 1.16)
    width = around(rng, 0.085 * size, 0.1)
    depth = width * between(rng, 0.58, 1.0)
    cap = min(around(rng, 0.036, 0.2), 0.85 * depth)
    with_nozzle = rng.random() < 0.6
    return sauce_bottle(
        width=width,
        depth=depth,
        body_height=around(rng, 0.130 * size, 0.12),
        shoulder_height=between(rng, 0.15, 0.9) * (width - cap),
        waist=between(rng, 0.8, 1.0),
        exponent=between(rng, 2.0, 2.8),
        cap_diameter=cap,
        cap_height=around(rng, 0.022, 0.25),
        cap_taper=between(rng, 0.75, 1.0),
        nozzle_diameter=cap * between(rng, 0.35, 0.65),
        nozzle_height=around(rng, 0.018, 0.25) if with_nozzle else 0.0,
    )


def any_bottle(rng: np.random.Generator) -> CatalogueObject:
    """Return a random bottle: a wide one is tall, its neck grows more slowly."""
    kind = rng.integers(3)
    size = between(rng, 0.80, 1.16)
    if kind == 0:
        return bottle(
            diameter=around(rng, 0.066 * size, 0.05),
            body_height=around(rng, 0.145 * size, 0.10),
            shoulder_height=around(rng, 0.038 * size, 0.15),
            neck_diameter=around(rng, 0.028 * size**0.4, 0.05),
            neck_height=around(rng, 0.022, 0.15),
            cap_height=around(rng, 0.020, 0.12),
        )
    if kind == 1:
        size = min(size, 1.05)
        return wine_bottle(
            diameter=around(rng, 0.073 * size, 0.05),
            body_height=around(rng, 0.180 * size, 0.08),
            shoulder_height=around(rng, 0.045 * size, 0.2),
            neck_diameter=around(rng, 0.029, 0.04),
            neck_height=around(rng, 0.042 * size, 0.15),
            cap_height=around(rng, 0.040, 0.15),
        )
    width = around(rng, 0.088 * size, 0.08)
    return squeeze_bottle(
        width=width,
        depth=width * between(rng, 0.58, 0.92),
        body_height=around(rng, 0.145 * size, 0.10),
        shoulder_height=around(rng, 0.030 * size, 0.15),
        neck_diameter=around(rng, 0.030 * size**0.5, 0.08),
        cap_height=around(rng, 0.032, 0.15),
    )


def _oval(
    low: float,
    high: float,
    profile: list[tuple[float, float, float]],
    *,
    exponent: float,
    round_start: float = 0.0,
) -> Mesh:
    """Return a piece of an upright bottle whose cross-section varies from low to high (`limb`)."""
    return limb(
        [(0, 0, low), (0, 0, high)],
        profile,
        (1, 0, 0),
        exponent=exponent,
        round_start=round_start,
        segments=48,
    )


def _cylinder(radius: float, low: float, high: float) -> list[tuple[float, float]]:
    edge = min(0.001, 0.2 * (high - low))
    return [
        (0, low),
        (radius - edge, low),
        (radius, low + edge),
        (radius, high - edge),
        (radius - edge, high),
        (0, high),
    ]
