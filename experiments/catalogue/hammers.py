"""Hammers: a heavy head across the end of a handle."""

from __future__ import annotations

import numpy as np

from experiments.catalogue.draws import around, between
from experiments.catalogue.forms import limb
from experiments.catalogue.model import RUBBER, STEEL, WOOD, CatalogueObject, Mesh, Part
from experiments.catalogue.shapes import superellipse, sweep

REGIONS = {"hammering": ("handle",), "handover": ("head",)}


def hammer(
    *,
    length: float = 0.320,
    head_length: float = 0.125,
    head_width: float = 0.030,
    claw_droop: float = 0.026,
    handle_width: float = 0.038,
) -> CatalogueObject:
    """Return a claw hammer in the x-y plane: head at +x, its face towards -y; metres.

    About the size of a 16 oz hammer. `claw_droop` is how far the claws bend back
    towards the handle.
    """
    stout = handle_width / 0.038
    share = np.array([0.0, 0.015, 0.06, 0.20, 0.40, 0.60, 0.75, 0.90, 1.0])
    wide = np.array([0.026, 0.035, 0.038, 0.036, 0.034, 0.029, 0.026, 0.027, 0.027]) * stout
    thick = np.array([0.018, 0.025, 0.027, 0.026, 0.025, 0.021, 0.019, 0.020, 0.020]) * stout
    spine = np.column_stack([(length - 0.004) * share, 0 * share, 0 * share])
    handle = sweep(
        spine,
        [superellipse(w, t, 2.3) for w, t in zip(wide, thick, strict=True)],
        side=(0, 1, 0),
    )
    head = _claw_head(length, head_length, head_width, claw_droop)
    return CatalogueObject(
        "hammer",
        "claw hammer",
        (Part("handle", (handle,), WOOD), Part("head", head, STEEL)),
        REGIONS,
    )


def framing_hammer(
    *,
    length: float = 0.385,
    head_length: float = 0.140,
    head_width: float = 0.031,
    grip_length: float = 0.175,
    grip_width: float = 0.036,
) -> CatalogueObject:
    """Return a framing hammer: straight claws, a steel shaft and a rubber grip; metres."""
    w = grip_width
    grip = limb(
        [(0, 0, 0), (0.5 * grip_length, -0.002, 0), (grip_length, 0, 0)],
        [
            (0.0, 1.02 * w, 0.72 * w),
            (0.10, 1.10 * w, 0.76 * w),
            (0.30, 0.88 * w, 0.70 * w),
            (0.62, w, 0.74 * w),
            (1.0, 0.80 * w, 0.62 * w),
        ],
        (0, 1, 0),
        round_start=0.010,
        round_end=0.006,
    )
    shaft = limb(
        [(0.6 * grip_length, 0, 0), (length - 0.004, 0, 0)],
        [(0, 0.022, 0.013), (0.5, 0.021, 0.012), (1, 0.025, 0.018)],
        (0, 1, 0),
        exponent=4,
    )
    return CatalogueObject(
        "framing_hammer",
        "framing hammer with a steel shaft",
        (
            Part("grip", (grip,), RUBBER),
            Part("shaft", (shaft,), STEEL),
            Part("head", _claw_head(length, head_length, head_width, 0.007), STEEL),
        ),
        {"hammering": ("grip", "shaft"), "handover": ("head",)},
    )


def ball_peen(
    *,
    length: float = 0.330,
    head_length: float = 0.105,
    head_width: float = 0.034,
    handle_width: float = 0.034,
) -> CatalogueObject:
    """Return an engineer's hammer: a flat face towards -y, a ball towards +y; metres."""
    eye, d = length - 0.45 * head_width, head_width
    face = limb(
        [(eye, -0.46 * head_length, 0), (eye, 0.22 * head_length, 0)],
        [
            (0.0, 0.86 * d, 0.86 * d),
            (0.04, 0.94 * d, 0.94 * d),
            (0.22, 0.94 * d, 0.94 * d),
            (0.34, 0.72 * d, 0.72 * d),
            (0.46, 0.72 * d, 0.72 * d),
            (0.62, d, 0.92 * d),
            (0.82, d, 0.92 * d),
            (1.0, 0.55 * d, 0.55 * d),
        ],
        (1, 0, 0),
        exponent=2.1,
        steps=48,
    )
    ball = limb(
        [(eye, 0.14 * head_length, 0), (eye, 0.54 * head_length, 0)],
        [(0.0, 0.5 * d, 0.5 * d), (0.30, 0.52 * d, 0.52 * d), (0.62, 0.86 * d, 0.86 * d),
         (1.0, 0.88 * d, 0.88 * d)],
        (1, 0, 0),
        exponent=2,
        round_end=0.42 * d,
    )  # fmt: skip
    return CatalogueObject(
        "ball_peen",
        "ball-peen hammer",
        (
            Part("handle", (_wooden_handle(length, handle_width),), WOOD),
            Part("head", (face, ball), STEEL),
        ),
        REGIONS,
    )


def mallet(
    *,
    length: float = 0.320,
    head_length: float = 0.110,
    head_diameter: float = 0.060,
    handle_width: float = 0.034,
) -> CatalogueObject:
    """Return a rubber mallet: a barrel across a wooden handle; metres."""
    eye, d = length - 0.5 * head_diameter, head_diameter
    head = limb(
        [(eye, -head_length / 2, 0), (eye, head_length / 2, 0)],
        [(0, 0.95 * d, 0.95 * d), (0.5, d, d), (1, 0.95 * d, 0.95 * d)],
        (1, 0, 0),
        exponent=2,
        round_start=0.004,
        round_end=0.004,
        segments=36,
    )
    return CatalogueObject(
        "mallet",
        "rubber mallet",
        (
            Part("handle", (_wooden_handle(length, handle_width),), WOOD),
            Part("head", (head,), RUBBER),
        ),
        REGIONS,
    )


def any_hammer(rng: np.random.Generator) -> CatalogueObject:
    """Return a random hammer; head and handle grow together."""
    kind = rng.integers(4)
    size = between(rng, 0.82, 1.15)
    length = around(rng, 0.320 * size, 0.06)
    handle_width = around(rng, 0.035 * size**0.3, 0.07)
    if kind == 0:
        return hammer(
            length=length,
            head_length=around(rng, 0.125 * size, 0.06),
            head_width=around(rng, 0.030 * size, 0.05),
            claw_droop=between(rng, 0.014, 0.034),
            handle_width=handle_width,
        )
    if kind == 1:
        return framing_hammer(
            length=1.12 * length,
            head_length=around(rng, 0.138 * size, 0.05),
            head_width=around(rng, 0.031 * size, 0.05),
            grip_length=around(rng, 0.165, 0.08),
            grip_width=handle_width,
        )
    if kind == 2:
        return ball_peen(
            length=length,
            head_length=around(rng, 0.105 * size, 0.07),
            head_width=around(rng, 0.034 * size, 0.05),
            handle_width=0.95 * handle_width,
        )
    return mallet(
        length=length,
        head_length=around(rng, 0.110 * size, 0.08),
        head_diameter=around(rng, 0.060 * size, 0.08),
        handle_width=handle_width,
    )


def _wooden_handle(length: float, width: float) -> Mesh:
    return limb(
        [(0, 0, 0), (length - 0.002, 0, 0)],
        [
            (0.0, 0.92 * width, 0.68 * width),
            (0.12, width, 0.74 * width),
            (0.35, 0.96 * width, 0.72 * width),
            (0.66, 0.66 * width, 0.56 * width),
            (0.86, 0.70 * width, 0.54 * width),
            (1.0, 0.72 * width, 0.54 * width),
        ],
        (0, 1, 0),
        exponent=2.2,
        round_start=0.008,
    )


def _claw_head(
    length: float, head_length: float, head_width: float, droop: float
) -> tuple[Mesh, ...]:
    """Return the poll with its face, and two claws."""
    eye, scale, reach = length - 0.016, head_width / 0.030, head_length / 0.125
    face = -0.45 * head_length
    along = face + np.array([0.0, 0.002, 0.014, 0.018, 0.026, 0.034, 0.048, 0.066, 0.074]) * reach
    round_ = np.array([0.024, 0.028, 0.028, 0.023, 0.021, 0.024, 0.030, 0.030, 0.026]) * scale
    poll = sweep(
        np.column_stack([np.full_like(along, eye), along, 0 * along]),
        [superellipse(d, d, e) for d, e in zip(round_, [2.2] * 5 + [2.6] * 4, strict=True)],
        side=(1, 0, 0),
    )
    claws = (_claw(eye, 0.55 * head_length, sign, droop, scale) for sign in (-1.0, 1.0))
    return (poll, *claws)


def _claw(eye: float, reach: float, sign: float, droop: float, scale: float) -> Mesh:
    """Return one prong: from the cheek to y = `reach`, bent back towards the handle."""
    share = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
    spine = np.column_stack(
        [
            eye + 0.002 - droop * share**2,
            0.008 + (reach - 0.008) * share,
            sign * (0.0070 + 0.0045 * share) * scale,
        ]
    )
    thick = np.array([0.024, 0.020, 0.015, 0.011, 0.007, 0.003]) * scale
    wide = np.array([0.014, 0.0135, 0.013, 0.012, 0.011, 0.009]) * scale
    sections = [superellipse(t, w, 3) for t, w in zip(thick, wide, strict=True)]
    return sweep(spine, sections, side=(1, 0, 0))
