"""Bottles: body, shoulder, neck and cap of one turned profile."""

from __future__ import annotations

import numpy as np

from experiments.catalogue.model import WATER, CatalogueObject, Part
from experiments.catalogue.shapes import revolve


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
        "half-litre bottle with a screw cap",
        parts,
        {"pouring": ("body", "shoulder"), "handover": ("neck", "cap")},
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
