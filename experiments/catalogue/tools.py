"""Hammer and scissors."""

from __future__ import annotations

import numpy as np

from experiments.catalogue.model import NYLON, STEEL, WOOD, CatalogueObject, Mesh, Part
from experiments.catalogue.shapes import superellipse, sweep


def hammer(*, length: float = 0.320, head_length: float = 0.125) -> CatalogueObject:
    """Return a claw hammer in the x-y plane: head at +x, its face towards -y; metres.

    About the size of a 16 oz hammer.
    """
    share = np.array([0.0, 0.015, 0.06, 0.20, 0.40, 0.60, 0.75, 0.90, 1.0])
    wide = np.array([0.026, 0.035, 0.038, 0.036, 0.034, 0.029, 0.026, 0.027, 0.027])
    thick = np.array([0.018, 0.025, 0.027, 0.026, 0.025, 0.021, 0.019, 0.020, 0.020])
    spine = np.column_stack([(length - 0.004) * share, 0 * share, 0 * share])
    handle = sweep(
        spine,
        [superellipse(w, t, 2.3) for w, t in zip(wide, thick, strict=True)],
        side=(0, 1, 0),
    )
    eye = length - 0.016
    face = -0.45 * head_length
    along = face + np.array([0.0, 0.002, 0.014, 0.018, 0.026, 0.034, 0.048, 0.066, 0.074])
    round_ = np.array([0.024, 0.028, 0.028, 0.023, 0.021, 0.024, 0.030, 0.030, 0.026])
    poll = sweep(
        np.column_stack([np.full_like(along, eye), along, 0 * along]),
        [superellipse(d, d, e) for d, e in zip(round_, [2.2] * 5 + [2.6] * 4, strict=True)],
        side=(1, 0, 0),
    )
    claws = tuple(_claw(eye, 0.55 * head_length, sign) for sign in (-1.0, 1.0))
    return CatalogueObject(
        "hammer",
        "claw hammer",
        (Part("handle", (handle,), WOOD), Part("head", (poll, *claws), STEEL)),
        {"hammering": ("handle",), "handover": ("head",)},
    )


def _claw(eye: float, reach: float, sign: float) -> Mesh:
    """Return one prong: from the cheek to y = `reach`, bent back towards the handle."""
    share = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
    spine = np.column_stack(
        [
            eye + 0.002 - 0.026 * share**2,
            0.008 + (reach - 0.008) * share,
            sign * (0.0070 + 0.0045 * share),
        ]
    )
    thick = np.array([0.024, 0.020, 0.015, 0.011, 0.007, 0.003])
    wide = np.array([0.014, 0.0135, 0.013, 0.012, 0.011, 0.009])
    sections = [superellipse(t, w, 3) for t, w in zip(thick, wide, strict=True)]
    return sweep(spine, sections, side=(1, 0, 0))


def scissors(*, length: float = 0.200, opening_deg: float = 18.0) -> CatalogueObject:
    """Return scissors in the x-y plane, pivot at the origin, tips towards +x; metres."""
    blades, grips = [], []
    for sign in (-1.0, 1.0):
        half = sign * np.radians(opening_deg) / 2
        turn = np.array(
            [[np.cos(half), -np.sin(half), 0], [np.sin(half), np.cos(half), 0], [0, 0, 1]]
        )
        level = -sign * 0.0014
        share = np.array([0.0, 0.1, 0.3, 0.6, 0.85, 1.0])
        wide = np.array([0.016, 0.018, 0.017, 0.013, 0.007, 0.002])
        along = -0.012 + (0.52 * length + 0.012) * share
        spine = np.column_stack([along, sign * (0.009 - wide / 2), np.full_like(along, level)])
        thin = [superellipse(w, 0.0026, 4) for w in wide]
        blades.append(sweep(spine @ turn.T, thin, side=turn @ [0, -1, 0]))
        shank = np.column_stack(
            [
                [-0.006, -0.020, -0.032, -0.042],
                np.multiply(-sign, [0.000, 0.004, 0.009, 0.012]),
                [level, level, 0, 0],
            ]
        )
        stem = [
            superellipse(w, t, 3)
            for w, t in ((0.016, 0.003), (0.013, 0.006), (0.011, 0.009), (0.010, 0.010))
        ]
        grips.append(sweep(shank @ turn.T, stem, side=(0, 1, 0)))
        angle = np.linspace(0, 2 * np.pi, 32, endpoint=False)
        loop = np.column_stack(
            [
                -0.068 + 0.030 * np.cos(angle),
                -sign * 0.021 + 0.017 * np.sin(angle),
                np.zeros_like(angle),
            ]
        )
        grips.append(
            sweep(
                loop @ turn.T,
                [superellipse(0.009, 0.010, 2.3, 16)] * 32,
                side=(0, 0, 1),
                closed=True,
            )
        )
    return CatalogueObject(
        "scissors",
        "household scissors, slightly open",
        (Part("blades", tuple(blades), STEEL), Part("handles", tuple(grips), NYLON)),
        {"cutting": ("handles",), "handover": ("blades",)},
    )
