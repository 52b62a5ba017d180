"""Spoons and knives."""

from __future__ import annotations

import numpy as np

from experiments.catalogue.model import NYLON, STEEL, CatalogueObject, Part
from experiments.catalogue.shapes import loft, revolve, scaled, superellipse, sweep


def spoon(
    *,
    bowl_length: float = 0.066,
    bowl_width: float = 0.044,
    bowl_depth: float = 0.011,
    handle_length: float = 0.140,
) -> CatalogueObject:
    """Return a table spoon, bowl opening towards +z, handle along -x; lengths in metres."""
    wall = 0.0015
    angle = np.linspace(0, np.pi / 2, 10)
    outside = np.column_stack([np.sin(angle), -bowl_depth * np.cos(angle)])
    inside = np.column_stack(
        [(1 - 2 * wall / bowl_width) * np.sin(angle), -(bowl_depth - wall) * np.cos(angle)]
    )[::-1]
    bowl = scaled(revolve(np.vstack([outside, inside])), (bowl_length / 2, bowl_width / 2, 1))
    share = np.array([0.0, 0.06, 0.18, 0.40, 0.65, 0.85, 0.95, 1.0])
    width = np.array([0.014, 0.008, 0.0065, 0.008, 0.013, 0.019, 0.018, 0.008])
    thick = np.array([0.0015, 0.003, 0.0035, 0.003, 0.0025, 0.0022, 0.002, 0.0015])
    rise = np.array([-0.003, 0.000, 0.006, 0.014, 0.014, 0.008, 0.004, 0.002])
    spine = np.column_stack(
        [0.003 - bowl_length / 2 - handle_length * share, np.zeros_like(share), rise]
    )
    sections = [superellipse(w, t, 3) for w, t in zip(width, thick, strict=True)]
    return CatalogueObject(
        "spoon",
        "table spoon",
        (
            Part("bowl", (bowl,), STEEL),
            Part("handle", (sweep(spine, sections, side=(0, -1, 0)),), STEEL),
        ),
        {"scooping": ("handle",), "handover": ("bowl",)},
    )


def knife(
    *, blade_length: float = 0.200, blade_height: float = 0.045, handle_length: float = 0.125
) -> CatalogueObject:
    """Return a chef's knife in the x-z plane, tip towards +x, edge down; lengths in metres."""
    share = np.array([0.0, 0.25, 0.5, 0.7, 0.82, 0.92, 0.98, 1.0])
    back = np.array([0.0, 0.0, -0.001, -0.004, -0.008, -0.014, -0.020, -0.024])
    edge = np.array([-1.0, -1.0, -0.98, -0.92, -0.84, -0.72, -0.60, -0.555]) * blade_height
    thick = np.array([0.0025, 0.0024, 0.0022, 0.002, 0.0018, 0.0015, 0.0012, 0.001])
    rings = [
        np.array([[x, -t / 2, top], [x, t / 2, top], [x, t / 20, low], [x, -t / 20, low]])[::-1]
        for x, top, low, t in zip(blade_length * share, back, edge, thick, strict=True)
    ]
    along = np.array([0.0, 0.04, 0.25, 0.5, 0.75, 0.93, 0.98, 1.0])
    tall = np.array([0.022, 0.025, 0.026, 0.024, 0.025, 0.028, 0.024, 0.014])
    wide = np.array([0.014, 0.017, 0.019, 0.018, 0.018, 0.018, 0.015, 0.008])
    drop = np.array([-0.013, -0.013, -0.013, -0.011, -0.013, -0.016, -0.017, -0.018])
    spine = np.column_stack([0.004 - handle_length * along, np.zeros_like(along), drop])
    sections = [superellipse(w, t, 2.8) for w, t in zip(wide, tall, strict=True)]
    return CatalogueObject(
        "knife",
        "chef's knife",
        (
            Part("blade", (loft(rings),), STEEL),
            Part("handle", (sweep(spine, sections, side=(0, -1, 0)),), NYLON),
        ),
        {"cutting": ("handle",), "handover": ("blade",)},
    )
