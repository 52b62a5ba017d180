"""Things to cook with: a vessel or a blade, and a handle."""

from __future__ import annotations

import numpy as np

from experiments.catalogue.model import NYLON, STEEL, CatalogueObject, Mesh, Part
from experiments.catalogue.shapes import box, moved, revolve, superellipse, sweep
from shared.geometry.rotation import frame_from_z


def saucepan(
    *,
    diameter: float = 0.180,
    height: float = 0.095,
    wall: float = 0.0025,
    handle_length: float = 0.185,
) -> CatalogueObject:
    """Return a saucepan standing on z = 0, its handle along +x; all lengths in metres."""
    radius = diameter / 2
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
    width = np.array([0.020, 0.018, 0.018, 0.021, 0.024, 0.025, 0.025, 0.021, 0.012])
    thick = np.array([0.012, 0.012, 0.014, 0.017, 0.019, 0.019, 0.018, 0.015, 0.008])
    spine = np.column_stack(
        [
            radius - 0.004 + handle_length * share,
            np.zeros_like(share),
            0.80 * height + 0.020 * np.sin(share * np.pi / 2),
        ]
    )
    sections = [superellipse(w, t, 2.4) for w, t in zip(width, thick, strict=True)]
    return CatalogueObject(
        "saucepan",
        "1.8 litre saucepan with a long handle",
        (
            Part("pot", (pot,), STEEL),
            Part("handle", (sweep(spine, sections, side=(0, 1, 0)),), NYLON),
        ),
        {"cooking": ("handle",), "handover": ("pot",)},
    )


def ladle(
    *,
    bowl_diameter: float = 0.090,
    bowl_depth: float = 0.040,
    handle_length: float = 0.270,
    lean_deg: float = 20.0,
) -> CatalogueObject:
    """Return a ladle, bowl opening towards +z, handle rising from its rim at +x.

    All lengths in metres; `lean_deg` is how far the handle leans from the vertical.
    """
    radius, wall = bowl_diameter / 2, 0.0018
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
    width = np.array([0.024, 0.018, 0.014, 0.014, 0.022, 0.026, 0.026, 0.014])
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
        {"scooping": ("handle",), "handover": ("bowl",)},
    )


def spatula(
    *,
    blade_length: float = 0.095,
    blade_width: float = 0.078,
    handle_length: float = 0.225,
    bend_deg: float = 28.0,
    slots: int = 4,
) -> CatalogueObject:
    """Return a slotted turner: the blade along +x, the handle along -x; lengths in metres.

    The blade slopes down from the handle by `bend_deg`.
    """
    bend = np.radians(bend_deg)
    down = frame_from_z((np.sin(bend), 0, np.cos(bend)), x_hint=(1, 0, 0))
    blade = [
        moved(mesh, (0.010, 0, -0.004), down) for mesh in _grille(blade_length, blade_width, slots)
    ]
    share = np.array([0.0, 0.05, 0.16, 0.36, 0.46, 0.70, 0.92, 0.98, 1.0])
    width = np.array([0.030, 0.024, 0.012, 0.012, 0.021, 0.025, 0.025, 0.020, 0.012])
    thick = np.array([0.0035, 0.005, 0.008, 0.008, 0.013, 0.015, 0.015, 0.011, 0.006])
    along = 0.020 - handle_length * share
    bow = np.where(along > 0, -np.tan(bend) * along, 0.0)
    spine = np.column_stack([along, np.zeros_like(along), bow])
    sections = [superellipse(w, t, 2.6) for w, t in zip(width, thick, strict=True)]
    return CatalogueObject(
        "spatula",
        "slotted turner",
        (
            Part("blade", tuple(blade), NYLON),
            Part("handle", (sweep(spine, sections, side=(0, -1, 0)),), NYLON),
        ),
        {"turning": ("handle",), "handover": ("blade",)},
    )


def _grille(length: float, width: float, slots: int) -> list[Mesh]:
    """Return a slotted plate from x = 0 to `length` about y = 0, as bars that overlap."""
    thickness, slot = 0.0025, 0.006
    bar = (width - slots * slot) / (slots + 1)
    heel, toe = 0.24 * length, 0.16 * length
    across = [
        box((heel, width, thickness), (heel / 2, 0, 0)),
        box((toe, width, thickness), (length - toe / 2, 0, 0)),
    ]
    pitch = bar + slot
    lanes = (np.arange(slots + 1) - slots / 2) * pitch
    return across + [box((length, bar, thickness), (length / 2, lane, 0)) for lane in lanes]
