"""Spatulas of the turner kind: a flat blade on a bent neck."""

from __future__ import annotations

import numpy as np

from experiments.catalogue.draws import around, between
from experiments.catalogue.forms import limb, plate
from experiments.catalogue.model import NYLON, STEEL, WOOD, CatalogueObject, Mesh, Part
from experiments.catalogue.shapes import box, moved, superellipse, sweep
from shared.geometry.rotation import frame_from_z

Array = np.ndarray[tuple[int, ...], np.dtype[np.float64]]

REGIONS = {"turning": ("handle",), "handover": ("blade",)}


def spatula(
    *,
    blade_length: float = 0.095,
    blade_width: float = 0.078,
    handle_length: float = 0.225,
    bend_deg: float = 28.0,
    slots: int = 4,
    handle_width: float = 0.025,
) -> CatalogueObject:
    """Return a slotted turner: the blade along +x, the handle along -x; lengths in metres.

    The blade slopes down from the handle by `bend_deg`.
    """
    bend, stout = np.radians(bend_deg), handle_width / 0.025
    blade = [
        moved(mesh, (0.010, 0, -0.004), _downwards(bend_deg))
        for mesh in _grille(blade_length, blade_width, slots)
    ]
    share = np.array([0.0, 0.05, 0.16, 0.36, 0.46, 0.70, 0.92, 0.98, 1.0])
    width = np.array([0.030, 0.024, 0.012, 0.012, 0.021, 0.025, 0.025, 0.020, 0.012]) * stout
    thick = np.array([0.0035, 0.005, 0.008, 0.008, 0.013, 0.015, 0.015, 0.011, 0.006]) * stout
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
        REGIONS,
    )


def solid_turner(
    *,
    blade_length: float = 0.105,
    blade_width: float = 0.080,
    handle_length: float = 0.250,
    bend_deg: float = 32.0,
    handle_width: float = 0.026,
) -> CatalogueObject:
    """Return a steel turner: an unbroken blade, a rod for a neck, a wooden grip; metres."""
    outline = [
        (0.0, 0.45 * blade_width),
        (0.06 * blade_length, 0.66 * blade_width),
        (0.20 * blade_length, 0.76 * blade_width),
        (0.93 * blade_length, blade_width),
        (0.98 * blade_length, 0.93 * blade_width),
        (blade_length, 0.80 * blade_width),
    ]
    blade = moved(plate(outline, 0.0018), (0.012, 0, -0.006), _downwards(bend_deg))
    neck, grip = _neck_and_grip(handle_length, handle_width, bend_deg, neck_share=0.46)
    return CatalogueObject(
        "solid_turner",
        "steel turner with a wooden grip",
        (
            Part("blade", (blade,), STEEL),
            Part("handle", (grip,), WOOD),
            Part("neck", (neck,), STEEL),
        ),
        {"turning": ("handle", "neck"), "handover": ("blade",)},
    )


def fish_turner(
    *,
    blade_length: float = 0.145,
    blade_width: float = 0.085,
    handle_length: float = 0.205,
    bend_deg: float = 16.0,
    slots: int = 5,
    handle_width: float = 0.024,
) -> CatalogueObject:
    """Return a fish turner: a long thin blade with slots that fan out; metres."""
    thickness, heel_width = 0.0018, 0.48 * blade_width
    heel = [(0.0, 0.55 * heel_width), (0.08, 0.85 * heel_width), (0.24, 1.06 * heel_width)]
    toe = [(0.86, 0.965 * blade_width), (0.96, blade_width), (0.99, 0.96 * blade_width)]
    meshes = [
        plate(np.array(heel) * [blade_length, 1], thickness, steps=8),
        plate(np.array([*toe, (1.0, 0.88 * blade_width)]) * [blade_length, 1], thickness, steps=8),
    ]
    for lane in np.linspace(-1, 1, slots + 1):
        wide = 0.34 * blade_width / slots
        ends = np.array([(0.20, 0.47 * heel_width), (0.90, 0.46 * blade_width)])
        spine = [(x * blade_length, lane * (y - wide / 2), 0) for x, y in ends]
        bars = [superellipse(0.8 * wide, thickness, 9, 24), superellipse(wide, thickness, 9, 24)]
        meshes.append(sweep(spine, bars, side=(0, 1, 0)))
    blade = [moved(mesh, (0.012, 0, -0.0035), _downwards(bend_deg)) for mesh in meshes]
    neck, grip = _neck_and_grip(handle_length, handle_width, bend_deg, neck_share=0.34)
    return CatalogueObject(
        "fish_turner",
        "fish turner with a fan of slots",
        (
            Part("blade", tuple(blade), STEEL),
            Part("handle", (grip,), NYLON),
            Part("neck", (neck,), STEEL),
        ),
        {"turning": ("handle", "neck"), "handover": ("blade",)},
    )


def any_spatula(rng: np.random.Generator) -> CatalogueObject:
    """Return a random turner; a long blade is wide and comes with a long handle."""
    kind = rng.integers(3)
    size = between(rng, 0.80, 1.20)
    width = around(rng, 0.025, 0.1)
    if kind == 0:
        return spatula(
            blade_length=around(rng, 0.095 * size, 0.08),
            blade_width=around(rng, 0.078 * size, 0.06),
            handle_length=around(rng, 0.225 * size**0.5, 0.06),
            bend_deg=between(rng, 15, 42),
            slots=int(rng.integers(3, 6)),
            handle_width=width,
        )
    if kind == 1:
        return solid_turner(
            blade_length=around(rng, 0.105 * size, 0.1),
            blade_width=around(rng, 0.078 * size, 0.08),
            handle_length=around(rng, 0.245 * size**0.5, 0.06),
            bend_deg=between(rng, 18, 45),
            handle_width=width,
        )
    return fish_turner(
        blade_length=around(rng, 0.145 * size, 0.08),
        blade_width=around(rng, 0.085 * size, 0.06),
        handle_length=around(rng, 0.210 * size**0.5, 0.06),
        bend_deg=between(rng, 8, 25),
        slots=int(rng.integers(4, 7)),
        handle_width=width,
    )


def _downwards(bend_deg: float) -> Array:
    bend = np.radians(bend_deg)
    return frame_from_z((np.sin(bend), 0, np.cos(bend)), x_hint=(1, 0, 0))


def _neck_and_grip(
    length: float, width: float, bend_deg: float, neck_share: float
) -> tuple[Mesh, Mesh]:
    """Return a flat rod from the blade's heel, and a grip on it that ends at -x."""
    slope = np.tan(np.radians(bend_deg))
    joint = 0.026 - neck_share * length
    neck = limb(
        [
            (0.030, 0, -0.006 - 0.018 * slope),
            (0.012, 0, -0.005),
            (-0.006, 0, 0.000),
            (joint, 0, 0.004),
            (joint - 0.03, 0, 0.005),
        ],
        [(0, 0.55 * width, 0.0028), (0.3, 0.45 * width, 0.004), (1, 0.35 * width, 0.005)],
        (0, -1, 0),
        exponent=3,
    )
    grip = limb(
        [(joint, 0, 0.004), ((joint + 0.026 - length) / 2, 0, 0.009), (0.026 - length, 0, 0.007)],
        [
            (0.0, 0.62 * width, 0.52 * width),
            (0.12, 0.78 * width, 0.62 * width),
            (0.5, 0.95 * width, 0.76 * width),
            (0.85, width, 0.78 * width),
            (1.0, 0.85 * width, 0.66 * width),
        ],
        (0, -1, 0),
        exponent=2.3,
        round_start=0.004,
        round_end=0.010,
    )
    return neck, grip


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
